/// Computes the worst-case damping and delay margin of the heading loop over the model's confidence
/// set. Private to tune/.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// For each mode, computes the smallest damping ratio and the smallest delay margin of the heading
/// loop (SampledHeadingLoop). The loop includes hold, servo, latency (with its fraction of a
/// sample) and motor lag. The minimum is over
///   - the plants of the 95 % ellipsoid of the model's covariance, projected on the parameters of
///     the loop: a3, b3, q3 of the yaw resistance, the normalised inertia I'z, and the servo's time
///     constant T. Plants with a negative exponent or resistance term are left out. In standard
///     normal coordinates n, the ellipsoid is |n| <= r, where r^2 is the 0.95 quantile of the
///     chi-squared distribution with PlantSampler::rank() degrees of freedom;
///   - all yaw rates in examined_rates_radps() and, if the `runs` of the mode turn faster than
///     these rates, the yaw rates up to the highest one of the runs;
///   - the mass factors of `open`.
/// If the model has no covariance, only the identified plant is examined. The heading law always
/// uses the identified plant, `context.plant`.
///
/// Each minimum is found by search: first the centre, the axes and the corners at five yaw rates
/// and 500 random points; then a pattern search from the best point of each orthant of the
/// ellipsoid. This is not a proof. In a test with nine vehicles, none of 20,000 random points
/// (5,000 for the delay margin) has a damping ratio or delay margin that is worse than the minimum
/// found by more than kCertificateTolerance (tests/tune/certificate_test.cpp). Errors (input):
/// those of PlantSampler::make().
Result<Certificate> certify(const Model& model, const ConstraintContext& context,
                            const UnmodelledVariation& open, const Gains<double>& gains,
                            std::span<const ModeScore> runs = {});

/// Accepted error of the minima that the search finds: of a damping ratio itself, and of a delay
/// margin as a fraction of the margin.
inline constexpr double kCertificateTolerance = 2e-3;

/// 95 % confidence set of the plant parameters on which the heading loop depends.
class ConfidenceSet {
 public:
  /// Errors (input): those of PlantSampler::make().
  static Result<ConfidenceSet> make(const Model& model);

  /// Dimension of the set, 0 ... 5.
  std::size_t dimension() const { return directions_.size(); }
  int parameters() const { return parameters_; }
  int rank() const { return sampler_ ? sampler_->rank() : 0; }
  /// Returns the plant at a point of the unit ball, which is mapped to the confidence ellipsoid.
  /// The centre of the ball is the identified plant. Empty if an exponent or a resistance term of
  /// the plant is negative.
  std::optional<Plant<double>> plant_at(std::span<const double> point) const;

 private:
  Plant<double> own_{};
  std::optional<PlantSampler> sampler_;
  double radius_ = 0.0;
  int parameters_ = 0;
  std::vector<std::vector<double>> directions_;
};

/// The heading loop that certify() examines for a plant, a yaw rate and a mode.
SampledHeadingLoop certified_loop(const Gains<double>& gains, const ConstraintContext& context,
                                  const Plant<double>& plant, double rate_radps, YawMode mode);

}  // namespace awmr
