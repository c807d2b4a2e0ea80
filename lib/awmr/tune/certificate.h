/// Worst-case damping and delay margin of the heading loop over the model's confidence set. Private to tune/.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// By mode, the smallest damping ratio and the smallest delay margin of SampledHeadingLoop with hold, servo, latency
/// (to a fraction of a sample) and motor lag, over
///   - the plants of the 95 % ellipsoid of the model's covariance, |n| <= r with r^2 the 0.95 quantile of the
///     chi-squared of PlantSampler::rank() degrees of freedom, seen in the parameters that the loop depends on
///     (a3, b3, q3, I'z, T), their exponents and terms not negative;
///   - every yaw rate from the slowest to the fastest that the runs reach;
///   - the masses of `open`.
/// Without a covariance: the model's own plant.
///
/// The law knows the context's own plant. Each minimum is searched for: the least of the centre, the axes, the corners
/// (at five yaw rates) and 500 random points, then a pattern search from the least of each orthant of the ellipsoid.
/// That is no proof; of 20,000 random points (5,000 for the margin) of each of nine vehicles none is worse by more than kCertificateTolerance
/// (tests/tune/certificate_test.cpp).
/// Errors (input): as PlantSampler::make.
Result<Certificate> certify(const Model& model, const ConstraintContext& context,
                            const OpenVehicle& open, const Gains<double>& gains);

/// Tolerance of the search for a minimum: a share of a delay margin, and as much of damping.
inline constexpr double kCertificateTolerance = 2e-3;

/// A plant of the confidence set that loops are examined with.
class ConfidenceSet {
 public:
  static Result<ConfidenceSet> make(const Model& model);

  /// Directions in which the set has an extent, 0 ... 5.
  std::size_t dimension() const { return directions_.size(); }
  int parameters() const { return parameters_; }
  int rank() const { return sampler_ ? sampler_->rank() : 0; }
  /// The plant at a point of the unit ball; the centre is the model's own. None where an exponent or a term is
  /// negative there.
  std::optional<Plant<double>> plant_at(std::span<const double> point) const;

 private:
  Plant<double> own_{};
  std::optional<PlantSampler> sampler_;
  double radius_ = 0.0;
  int parameters_ = 0;
  std::vector<std::vector<double>> directions_;
};

/// The loop that is certified, at a plant, a yaw rate and a mode.
SampledHeadingLoop certified_loop(const Gains<double>& gains, const ConstraintContext& context,
                                  const Plant<double>& plant, double rate_radps, YawMode mode);

}  // namespace awmr
