/// Plants drawn from the uncertainty of the model.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// The share of the draws whose mass is that which the grip demands.
inline constexpr double kGripShare = 0.25;

/// Draws the parameters of the model's covariance C, the others stay at their values. The
/// coordinate z of a parameter p (model/transform.h) is drawn from a normal about its estimate; by
/// the delta method, with dp/dz = p for a logarithm and 1 for a linear coordinate,
///   Cov(z_p, z_q) = C_pq / (dp/dz_p dq/dz_q).
///
/// An estimate with quantiles is no normal about its value. Its coordinate is drawn as a function of
/// the same normals, so that each marginal has the quantiles that model.json shows and the ranks go
/// together as C says (a Gaussian copula): z runs through the quantiles' coordinates, linear in the
/// normal score between and beyond them.
///
/// Where the model has mass_norm_by_grip, kGripShare of the draws have an m' of at least that, and
/// an I'z that is larger by the same factor: the trials' own m' asks for more grip than tyres have.
///
/// A quantity that has to be positive is drawn in its logarithm, so that its median is the model's
/// value. Exponents b and a family's terms (Coulomb, quadratic, dead zone) are drawn as they are,
/// and all parameters are drawn again until none of them is negative: a resistance neither falls with
/// speed nor pushes. The vehicle's surge_beta_range and yaw_beta_range bound fits, not draws: an
/// estimate near an end of its range has its uncertainty on both sides. A term that was fitted as 0
/// is drawn from the half of its normal above 0: its mean is 0.8 of its standard error, no longer the
/// estimate.
class PlantSampler {
 public:
  /// Draws have a scrub of their own where the model has one (YawScrub::std_error_m, which holds the
  /// error of g3 as well and is taken as independent of it).
  /// Errors (input): a parameter has no value; no covariance; one that is no covariance.
  static Result<PlantSampler> make(const Model& model);

  /// The plant of `sample` (>= 1): depends on seed and sample alone. Errors (input): next to
  /// every draw has a negative exponent or term.
  Result<Plant<double>> draw(std::uint64_t seed, int sample) const;
  /// The drawn plant as a model; its intervals are those of the identified model.
  Result<Model> draw_model(std::uint64_t seed, int sample) const;

  /// A Latin hypercube of `count` draws, evenly spread even for few draws. Each direction of the
  /// covariance has one draw in each of `count` strata of equal probability, in an order and at a
  /// place within it from the seed. One that is not admissible is draw()'s of its number.
  Result<std::vector<Plant<double>>> draw_evenly(std::uint64_t seed, int count) const;

  /// The plant at standard normals n, one for each parameter of the covariance: z = centre + L n.
  /// Empty if an exponent or a term is negative there. The mass that the grip demands is drawn
  /// only.
  std::optional<Plant<double>> plant_at(std::span<const double> normals) const;
  /// Degrees of freedom: the parameters lie in |n| <= r with the probability of a chi-squared of as many
  /// below r^2. Derived parameters (m' from a1, b1) add none.
  int rank() const;
  /// Orthonormal directions of n along which any of these parameters moves; along all others they stay.
  std::vector<std::vector<double>> directions_of(std::span<const ParameterId> ids) const;

 private:
  /// Number of standard normals per draw: one for each parameter of the covariance and, where the
  /// grip demands a mass, one that says whether it is taken.
  std::size_t normals_of_a_draw() const {
    return centre_.size() + (model_.mass_norm_by_grip ? 1 : 0);
  }
  /// The model at these normals, those of a draw or of plant_at(); empty if an exponent or a term
  /// is negative there.
  std::optional<Model> model_at(std::span<const double> normals) const;
  /// The model with a scrub `normal` standard errors from its own; as it is without one.
  Model with_scrub(Model drawn, double normal) const;

  Model model_;
  std::vector<double> centre_;                       ///< z by position in the covariance
  std::vector<std::vector<double>> factor_;          ///< L with L L^T = Cov(z)
  std::vector<double> deviation_;                    ///< sqrt of its diagonal
  std::vector<std::optional<Quantiles>> quantiles_;  ///< z of the estimate's, where it has them
};

}  // namespace awmr
