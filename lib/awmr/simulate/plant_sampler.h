/// Draws random plants from the uncertainty of a model, for robust tuning and comparisons.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// Fraction of the draws whose m' is raised to Model::mass_norm_by_grip.
inline constexpr double kGripShare = 0.25;

/// Draws the parameters in the model's covariance C; the others keep their values. The coordinate z
/// of a parameter p (p or ln p, model/transform.h) is normally distributed about its estimate. By
/// the delta method, with dp/dz = p for a logarithmic and 1 for a linear coordinate,
///   Cov(z_p, z_q) = C_pq / (dp/dz_p dq/dz_q).
///
/// For an estimate with quantiles, z is a piecewise linear function of the same normal number (a
/// Gaussian copula). This function passes through the coordinates of the quantiles and is
/// extrapolated beyond them. So the distribution of the parameter has the quantiles of model.json,
/// and its rank correlations are those of C.
///
/// If the model has mass_norm_by_grip, the identified m' requires more grip than tyres have. Then
/// in the fraction kGripShare of the draws, m' is raised to at least mass_norm_by_grip, and I'z by
/// the same factor.
///
/// Exponents and optional terms of a resistance (Coulomb, quadratic, dead zone) must not be
/// negative, because a resistance neither falls with speed nor drives the vehicle. All parameters
/// are drawn again until this holds. So a term that was fitted as 0 has a half-normal distribution
/// with a mean of 0.8 standard errors. surge_beta_range and yaw_beta_range of the vehicle do not
/// limit draws, because the true value of an estimate near an end of its range can lie beyond that
/// end.
class PlantSampler {
 public:
  /// A sampler for the model. The scrub moment, if the model has one, is drawn with
  /// YawScrub::std_error_m, independently of the parameters. Errors (input): a parameter has no
  /// value; the covariance is missing, has the wrong size, or is not positive semi-definite.
  static Result<PlantSampler> make(const Model& model);

  /// Draws the plant with the number `sample` (>= 1). The result depends only on `seed` and
  /// `sample`. Errors (input): each of 1000 attempts has a negative exponent or term.
  Result<Plant<double>> draw(std::uint64_t seed, int sample) const;
  /// Same as draw(), but returns the plant as a model, with the intervals of the identified model.
  Result<Model> draw_model(std::uint64_t seed, int sample) const;

  /// Latin hypercube of `count` draws, which cover the distribution evenly even if they are few.
  /// Each standard normal number has one value in each of `count` strata of equal probability. The
  /// seed determines the order of the strata and the position within each. If the i-th draw, i from
  /// 1, has a negative exponent or term, it is replaced by draw(seed, i).
  Result<std::vector<Plant<double>>> draw_evenly(std::uint64_t seed, int count) const;

  /// The plant for given standard normals n, one for each parameter of the covariance:
  /// z = centre + L n with L L^T = Cov(z); for parameters with quantiles, z is interpolated between
  /// them. Empty if an exponent or a term is negative, or the values are not a valid plant. m' is
  /// not raised to mass_norm_by_grip, and the scrub moment is that of the model.
  std::optional<Plant<double>> plant_at(std::span<const double> normals) const;
  /// Degrees of freedom k of the draws: the number of independent directions of the normals n on
  /// which the parameters depend. Let n' be the part of n in these directions. P(|n'| <= r) is the
  /// probability that a chi-squared variable with k degrees of freedom is below r^2. Derived
  /// parameters (m' from a1, b1) do not count.
  int rank() const;
  /// Orthonormal directions in the space of the normals n on which the parameters `ids` depend.
  /// Parameters that are not in the covariance are ignored.
  std::vector<std::vector<double>> directions_of(std::span<const ParameterId> ids) const;

 private:
  /// Number of standard normals per draw: one for each parameter of the covariance and, with
  /// mass_norm_by_grip, one that decides whether m' is raised.
  std::size_t normals_of_a_draw() const {
    return centre_.size() + (model_.mass_norm_by_grip ? 1 : 0);
  }
  /// The model for the normals of a draw or of plant_at(); empty if an exponent or a term is
  /// negative there.
  std::optional<Model> model_at(std::span<const double> normals) const;
  /// The model with its scrub moment at the estimate plus `normal` standard errors; unchanged
  /// without scrub.
  Model with_scrub(Model drawn, double normal) const;

  Model model_;
  std::vector<double> centre_;                       ///< z of the estimates, as in the covariance
  std::vector<std::vector<double>> factor_;          ///< L with L L^T = Cov(z)
  std::vector<double> deviation_;                    ///< standard deviation of z
  std::vector<std::optional<Quantiles>> quantiles_;  ///< z of the estimate's quantiles, if any
};

}  // namespace awmr
