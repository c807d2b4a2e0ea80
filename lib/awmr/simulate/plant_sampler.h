/// Plants drawn from the uncertainty of the model.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// Share of the draws with the mass that the grip limit requires.
inline constexpr double kGripShare = 0.25;

/// Draws the parameters in the model's covariance C; the others keep their values. The coordinate z
/// of a parameter p (model/transform.h) is normal about its estimate. By the delta method, with
/// dp/dz = p for a logarithm and 1 for a linear coordinate,
///   Cov(z_p, z_q) = C_pq / (dp/dz_p dq/dz_q).
///
/// An estimate with quantiles is not normal. Its coordinate is a function of the same normals (a
/// Gaussian copula), so that the marginal has the quantiles of model.json and the rank correlation
/// is that of C: z is piecewise linear in the normal score through the coordinates of the
/// quantiles, and extrapolated beyond them.
///
/// If the model has mass_norm_by_grip, the share kGripShare of the draws have at least that m', and
/// an I'z that is larger by the same factor, because the identified m' requires more grip than
/// tyres have.
///
/// A positive quantity is drawn in its logarithm, so that its median is the model's value.
/// Exponents b and a family's terms (Coulomb, quadratic, dead zone) are drawn linearly, and all
/// parameters are drawn again until none of these is negative, because a resistance neither
/// decreases with speed nor accelerates. surge_beta_range and yaw_beta_range of the vehicle bound
/// fits, but not draws, because an estimate near an end of its range is uncertain on both sides. A
/// term that was fitted as 0 has a half-normal distribution: its mean is 0.8 standard errors, not
/// the estimate.
class PlantSampler {
 public:
  /// If the model has a scrub, it is drawn too (by YawScrub::std_error_m, which includes the error
  /// of g3; assumed independent of the other parameters). Errors (input): a parameter has no value;
  /// no covariance; one that is not positive semi-definite.
  static Result<PlantSampler> make(const Model& model);

  /// The plant of `sample` (>= 1), which depends on seed and sample only. Errors (input): nearly
  /// every draw has a negative exponent or term.
  Result<Plant<double>> draw(std::uint64_t seed, int sample) const;
  /// The drawn plant as a model; its intervals are those of the identified model.
  Result<Model> draw_model(std::uint64_t seed, int sample) const;

  /// Latin hypercube of `count` draws, evenly distributed even for few draws. Each direction of the
  /// covariance has one draw in each of `count` strata of equal probability; order and position in
  /// the stratum are from the seed. An inadmissible draw is replaced by draw() with its number.
  Result<std::vector<Plant<double>>> draw_evenly(std::uint64_t seed, int count) const;

  /// The plant at standard normals n, one for each parameter of the covariance: z = centre + L n.
  /// Empty if an exponent or a term is negative there. Without the mass that the grip limit
  /// requires.
  std::optional<Plant<double>> plant_at(std::span<const double> normals) const;
  /// Degrees of freedom k: the parameters are in |n| <= r with the probability that a chi-squared
  /// variable with k degrees of freedom is below r^2. Derived parameters (m' from a1, b1) do not
  /// count.
  int rank() const;
  /// Orthonormal directions of n on which these parameters depend.
  std::vector<std::vector<double>> directions_of(std::span<const ParameterId> ids) const;

 private:
  /// Number of standard normals per draw: one for each parameter of the covariance and, if the grip
  /// limit requires a mass, one that decides whether this mass is used.
  std::size_t normals_of_a_draw() const {
    return centre_.size() + (model_.mass_norm_by_grip ? 1 : 0);
  }
  /// The model at these normals, those of a draw or of plant_at(); empty if an exponent or a term
  /// is negative there.
  std::optional<Model> model_at(std::span<const double> normals) const;
  /// The model with its scrub changed by `normal` standard errors; unchanged without scrub.
  Model with_scrub(Model drawn, double normal) const;

  Model model_;
  std::vector<double> centre_;                       ///< z by position in the covariance
  std::vector<std::vector<double>> factor_;          ///< L with L L^T = Cov(z)
  std::vector<double> deviation_;                    ///< sqrt of its diagonal
  std::vector<std::optional<Quantiles>> quantiles_;  ///< z of the estimate's quantiles, if any
};

}  // namespace awmr
