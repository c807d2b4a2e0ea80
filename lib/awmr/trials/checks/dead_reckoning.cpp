#include "dead_reckoning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>

#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {
namespace {

/// Movements between the readings of a log, and the rates at the readings.
struct OdometrySteps {
  std::vector<double> step_s;  ///< [i]: time from reading i to i + 1
  std::vector<double> moved;   ///< [i]: turn, rad, or distance, m, from reading i to i + 1
  std::vector<double> rate;    ///< yaw rate, rad/s, or magnitude of the speed, m/s
};

/// The movements of `pose`, the heading or the position, and the readings of `rate` at the rows
/// with both. Leaves out rows that repeat the row before, unless the vehicle is at rest: they repeat a
/// slower sensor. A step longer than three median steps is a gap, and counts as a median step.
OdometrySteps odometry_steps(const DrivingLog& log, std::span<const LogChannel> pose,
                             LogChannel rate) {
  OdometrySteps found;
  std::optional<std::size_t> last;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (!log[rate]->fresh[row] && log.joined) continue;
    const bool is_position = pose.size() > 1;
    const double value = log[rate]->value[row];
    const double reading = is_position ? std::abs(value) : value;
    double moved = 0.0;
    if (last) {
      const auto change = [&](LogChannel c) { return log[c]->value[row] - log[c]->value[*last]; };
      moved = is_position ? std::hypot(change(pose[0]), change(pose[1])) : change(pose[0]);
      if (moved == 0.0 && reading == found.rate.back() && reading != 0.0) continue;
      found.step_s.push_back(log.t_s[row] - log.t_s[*last]);
      found.moved.push_back(moved);
    }
    found.rate.push_back(reading);
    last = row;
  }
  if (found.step_s.empty()) return found;
  const double usual_s = median(found.step_s);
  for (double& step_s : found.step_s) {
    if (step_s > 3.0 * usual_s) step_s = usual_s;
  }
  return found;
}

/// Standard deviation of the noise of `values`: the smallest estimate from third to fifth
/// differences, in which the motion hardly remains. Uses the 30 % quantile of their magnitudes, so
/// that changes of the motion in most of the rows do not matter. Rests count as one reading.
double odometry_noise(std::span<const double> values) {
  constexpr double kQuantile = 0.3;
  constexpr double kNormalQuantile = 0.38532;  // 30 % quantile of the magnitude of N(0, 1)
  // Variance of a difference of n-th order in units of the variance of the values: binomial(2n, n).
  constexpr std::array<double, 6> kVariance{1.0, 2.0, 6.0, 20.0, 70.0, 252.0};
  std::vector<double> differences;
  std::ranges::unique_copy(values, std::back_inserter(differences),
                           [](double a, double b) { return a == 0.0 && b == 0.0; });
  if (differences.size() < kVariance.size()) return 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t order = 1; order < kVariance.size(); ++order) {
    for (std::size_t i = 0; i + 1 < differences.size(); ++i) {
      differences[i] = differences[i + 1] - differences[i];
    }
    differences.pop_back();
    if (order < 3) continue;
    std::vector<double> sizes = differences;
    for (double& size : sizes) size = std::abs(size);
    const double scale = kNormalQuantile * std::sqrt(kVariance[order]);
    smallest = std::min(smallest, quantile(std::move(sizes), kQuantile) / scale);
  }
  return smallest;
}

/// The rms of D - mean(D) (dead_reckoning.h) if the readings count from the `share` of each step
/// on: 0 its begin, 1 its end.
double difference_rms(const OdometrySteps& steps, double share) {
  double difference = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < steps.moved.size(); ++i) {
    const double rate = std::lerp(steps.rate[i], steps.rate[i + 1], share);
    difference += steps.moved[i] - rate * steps.step_s[i];
    sum += difference;
    squares += difference * difference;
  }
  const auto count = static_cast<double>(steps.moved.size());
  return std::sqrt(std::max(0.0, squares / count - std::pow(sum / count, 2)));
}

/// True if the pose is an integral of the readings (dead_reckoning.h).
bool is_integral(const OdometrySteps& steps) {
  constexpr std::size_t kMinReadings = 100;
  constexpr double kMuchLess = 0.2;
  if (steps.rate.size() < kMinReadings) return false;
  double squares = 0.0;
  for (const double step_s : steps.step_s) squares += step_s * step_s;
  const double limit = kMuchLess * odometry_noise(steps.rate) * std::sqrt(squares / 6.0);
  return std::ranges::any_of(std::array{0.0, 0.5, 1.0},
                             [&](double share) { return difference_rms(steps, share) < limit; });
}

void note_dead_reckoning(const DrivingLog& log, std::string_view columns, std::string_view sources,
                         std::vector<Finding>& findings) {
  findings.push_back(
      {log.file, 0, Severity::kNote, "dead-reckoning",
       fmt::format("{} only integrates {} (odometry, dead reckoning): it has no measurement of its "
                   "own, so the fit does not use it",
                   columns, sources)});
}

}  // namespace

void set_aside_dead_reckoning(DrivingLog& log, std::vector<Finding>& findings) {
  constexpr std::array kPosition{LogChannel::kX, LogChannel::kY};
  constexpr std::array kHeading{LogChannel::kHeading};
  const auto has = [&](LogChannel channel) { return log[channel].has_value(); };
  if (has(LogChannel::kX) && has(LogChannel::kY) && has(LogChannel::kSpeed) &&
      is_integral(odometry_steps(log, kPosition, LogChannel::kSpeed))) {
    note_dead_reckoning(log, "x_m, y_m", "speed_mps", findings);
    log[LogChannel::kX].reset();
    log[LogChannel::kY].reset();
  }
  if (has(LogChannel::kHeading) && has(LogChannel::kYawRate) &&
      is_integral(odometry_steps(log, kHeading, LogChannel::kYawRate))) {
    note_dead_reckoning(log, "heading_deg", "yaw_rate_radps", findings);
    log[LogChannel::kHeading].reset();
  }
}

}  // namespace awmr
