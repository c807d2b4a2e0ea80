/// Draws random plants from the uncertainty of a model, for robust tuning and comparisons.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// Fraction of the draws in which m' is raised to Model::mass_norm_by_grip (see PlantSampler). The
/// fraction is a choice: the larger it is, the more the draws trust the assumed grip of the tyres,
/// and the less the identified m'.
inline constexpr double kGripShare = 0.25;

/// Draws random plants. The parameters in the model's covariance C are drawn; all other parameters
/// keep their values. Each parameter p is drawn by its coordinate z, which is p or ln p
/// (model/transform.h). z is normally distributed about its estimate. The covariance of z follows
/// by the delta method, with dp/dz = p for z = ln p, and 1 for z = p:
///   Cov(z_p, z_q) = C_pq / (dp/dz_p dq/dz_q)
///
/// An estimate can have quantiles in model.json. Then z is a piecewise linear function of the
/// normal number (a Gaussian copula) through these quantiles, extrapolated beyond them. So the
/// parameter has these quantiles, and its rank correlations are those of C.
///
/// Model::mass_norm_by_grip is set if the identified normalised mass m' is too small: its
/// accelerations would need more grip than tyres have. Therefore, in the fraction kGripShare of the
/// draws, m' is raised to at least mass_norm_by_grip, and I'z by the same factor.
///
/// Exponents and optional terms of a resistance (Coulomb, quadratic, dead zone) must not be
/// negative, because a resistance does not fall with speed and does not drive the vehicle. If one
/// of them is negative, all parameters are drawn again. So a term that was fitted as 0 has a
/// half-normal distribution, whose mean is 0.8 standard errors. The vehicle's surge_beta_range and
/// yaw_beta_range do not limit the draws: the true value can lie beyond an end of its range.
class PlantSampler {
 public:
  /// Makes a sampler for the model. A scrub moment is drawn with its standard error
  /// (YawScrub::std_error_m), independently of the parameters. Errors (input): a parameter has no
  /// value; the covariance is missing, has the wrong size, or is not positive semi-definite.
  static Result<PlantSampler> make(const Model& model);

  /// Draws the plant with the number `sample` (>= 1), which depends only on `seed` and `sample`.
  /// Errors (input): each of 1000 attempts gave a negative exponent or term of a resistance.
  Result<Plant<double>> draw(std::uint64_t seed, int sample) const;
  /// Same as draw(), but returns the plant as a model, with the intervals of the identified model.
  Result<Model> draw_model(std::uint64_t seed, int sample) const;

  /// Draws `count` plants by a Latin hypercube, so that even a few draws cover the distribution
  /// evenly: the range of each standard normal number is divided into `count` strata of equal
  /// probability, and each stratum is used once. The seed determines the order of the strata and
  /// the position within each. If draw i (from 1) has a negative exponent or term, draw(seed, i)
  /// replaces it.
  Result<std::vector<Plant<double>>> draw_evenly(std::uint64_t seed, int count) const;

  /// Returns the plant for given standard normal numbers n, one for each parameter of the
  /// covariance:
  ///   z = centre + L n,  L L^T = Cov(z)
  /// z: coordinates of the parameters; centre: z of the estimates. For parameters with quantiles, z
  /// is interpolated between the quantiles. m' is not raised to mass_norm_by_grip, and the scrub
  /// moment is that of the model. Empty if an exponent or term is negative or the values are no
  /// valid plant.
  std::optional<Plant<double>> plant_at(std::span<const double> normals) const;
  /// Degrees of freedom k of the draws: number of independent directions of the normal numbers n
  /// that change a parameter. Derived parameters (m' from a1, b1) add none. Let n' be the part of n
  /// in these directions: |n'|^2 is a chi-squared variable with k degrees of freedom.
  int rank() const;
  /// Orthonormal directions in the space of the normal numbers n that change the parameters `ids`.
  /// Parameters that are not in the covariance are ignored.
  std::vector<std::vector<double>> directions_of(std::span<const ParameterId> ids) const;

 private:
  /// Number of standard normal numbers per draw: one for each parameter of the covariance, and with
  /// mass_norm_by_grip one that decides whether m' is raised.
  std::size_t normals_of_a_draw() const {
    return centre_.size() + (model_.mass_norm_by_grip ? 1 : 0);
  }
  /// Returns the model for the normal numbers of a draw or of plant_at(); empty if an exponent or
  /// term is negative.
  std::optional<Model> model_at(std::span<const double> normals) const;
  /// Returns the model with its scrub moment at the estimate plus `normal` standard errors;
  /// unchanged if the model has no scrub moment.
  Model with_scrub(Model drawn, double normal) const;

  Model model_;
  std::vector<double> centre_;                       ///< coordinates z of the estimates
  std::vector<std::vector<double>> factor_;          ///< L with L L^T = Cov(z)
  std::vector<double> deviation_;                    ///< standard deviation of z
  std::vector<std::optional<Quantiles>> quantiles_;  ///< coordinates z of the quantiles, if any
};

}  // namespace awmr
