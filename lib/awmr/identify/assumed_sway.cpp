#include "awmr/identify/assumed_sway.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "awmr/core/gravity.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/identify/identify.h"

namespace awmr {
namespace {

/// 95 % interval of the cornering stiffness c of a tyre, 1/rad (assumed_sway.h).
constexpr Interval kTyreStiffness{0.5, 16.0};
/// Half width of a 95 % interval of the normal distribution, in standard deviations.
constexpr double kNormal95 = 1.959964;
/// Quantile of a log's speeds that counts as its highest speed; the maximum could be a measurement
/// error.
constexpr double kFastestQuantile = 0.95;

void take_fastest(const DrivingLog& log, double& fastest_mps) {
  const std::optional<Measured>& speed = log[LogChannel::kSpeed];
  if (!speed) return;
  std::vector<double> speeds;
  for (std::size_t row = 0; row < speed->value.size(); ++row) {
    if (speed->fresh[row]) speeds.push_back(std::abs(speed->value[row]));
  }
  if (speeds.empty()) return;
  fastest_mps = std::max(fastest_mps, quantile(std::move(speeds), kFastestQuantile));
}

/// Highest speed of all trials, m/s; 0 if no trial has a speed.
double fastest_mps(const TrialData& data) {
  double fastest = 0.0;
  if (data.surge) {
    for (const SurgeRow& row : data.surge->rows) fastest = std::max(fastest, row.speed_mps);
  }
  if (data.coastdown) {
    for (const StopTimeRow& row : data.coastdown->rows) {
      fastest = std::max(fastest, row.initial_speed_mps);
    }
  }
  for (const CoastCurve& curve : data.curves) {
    for (const double speed : curve.speed_mps) fastest = std::max(fastest, std::abs(speed));
  }
  for (const DrivingLog& log : data.logs) take_fastest(log, fastest);
  return fastest;
}

double log_variance_of(const Interval& range) {
  const double half = 0.5 * std::log(range.hi / range.lo) / kNormal95;
  return half * half;
}

}  // namespace

double assumed_sway_factor() { return std::sqrt(kTyreStiffness.hi / kTyreStiffness.lo); }

void assume_sway(const TrialData& data, MainValues& values) {
  Model& model = values.model;
  Estimate& sway = model[ParameterId::kSwayAlpha];
  const Estimate& mass = model[ParameterId::kMassNorm];
  const double speed_mps = 0.5 * fastest_mps(data);
  const bool turns = model[ParameterId::kYawAlpha].value && model[ParameterId::kInertiaNorm].value;
  if (sway.value || !mass.value || !turns || !(speed_mps > 0.0)) return;
  const double stiffness = std::sqrt(kTyreStiffness.lo * kTyreStiffness.hi);
  const double per_mass = stiffness * kGravity_mps2 / speed_mps;
  const double value = per_mass * *mass.value;

  const double own_variance = log_variance_of(kTyreStiffness);
  JointCovariance::Gradient gradient{
      {values.covariance.add_block(Eigen::MatrixXd::Constant(1, 1, own_variance)), value}};
  if (values.covariance.has(ParameterId::kMassNorm)) {
    for (const auto& [place, slope] : values.covariance.gradient(ParameterId::kMassNorm)) {
      gradient[place] += per_mass * slope;
    }
  }
  const double std_error = std::sqrt(values.covariance.variance(gradient));
  const double factor = std::exp(kNormal95 * std_error / value);
  sway = {value, std_error, Interval{value / factor, value * factor}, Source::kDerived,
          kAssumedSwayMethod};
  values.covariance.set(ParameterId::kSwayAlpha, std::move(gradient));
  model.record.findings.push_back(
      {"", 0, Severity::kWarning, "assumed-sway",
       fmt::format(
           "no trial identifies the sway resistance (against sideways motion), so {} is assumed "
           "to be {:.3g} s/m ({:.3g} to {:.3g}). This is the value of common tyres, {:.1f} g "
           "m'/u (g: gravity), at u = {:.2g} m/s, half of the highest speed driven. Gains are "
           "tuned for that range, and sideslip results have the same uncertainty. Give "
           "sway_alpha in vehicle.json, or record a driving log with sway_mps",
           info(ParameterId::kSwayAlpha).name, value, sway.ci95->lo, sway.ci95->hi, stiffness,
           speed_mps)});
}

}  // namespace awmr
