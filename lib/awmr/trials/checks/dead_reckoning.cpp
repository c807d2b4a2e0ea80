#include "dead_reckoning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>

#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {
namespace {

using Complex = std::complex<double>;

/// The readings of the rows. Rows that repeat the row before, other than of a vehicle at rest, repeat
/// a slower sensor and are left out.
struct OdometrySteps {
  std::vector<double> step_s;     ///< [i]: time from reading i to i + 1
  std::vector<Complex> integral;  ///< heading, rad, or position x + iy, m
  std::vector<double> rate;       ///< yaw rate, rad/s, or speed, m/s
  std::vector<double> direction;  ///< direction of the rate, rad; 0 for a yaw rate
};

/// The readings of the log. The integral of `rate` in `direction` is compared with x + iy; without
/// `y` and `direction`, with x. A step longer than three median steps is a gap, and counts as a
/// median step.
OdometrySteps readings_of(const DrivingLog& log, LogChannel x, std::optional<LogChannel> y,
                          LogChannel rate, std::optional<LogChannel> direction) {
  OdometrySteps found;
  const auto value = [&](std::optional<LogChannel> channel, std::size_t row) {
    return channel ? log[*channel]->value[row] : 0.0;
  };
  std::vector<double> times;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const Complex integral{value(x, row), value(y, row)};
    const double reading = value(rate, row);
    const bool repeats =
        row > 0 && integral == found.integral.back() && reading == found.rate.back();
    if (repeats && reading != 0.0) continue;
    times.push_back(log.t_s[row]);
    found.integral.push_back(integral);
    found.rate.push_back(reading);
    found.direction.push_back(value(direction, row));
  }
  for (std::size_t i = 1; i < times.size(); ++i) found.step_s.push_back(times[i] - times[i - 1]);
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
double difference_rms(const OdometrySteps& readings, double share, double direction_share) {
  Complex difference;
  Complex sum;
  double squares = 0.0;
  const std::size_t steps = readings.step_s.size();
  for (std::size_t i = 0; i < steps; ++i) {
    const double rate = std::lerp(readings.rate[i], readings.rate[i + 1], share);
    const double direction =
        std::lerp(readings.direction[i], readings.direction[i + 1], direction_share);
    difference += readings.integral[i + 1] - readings.integral[i] -
                  std::polar(1.0, direction) * (rate * readings.step_s[i]);
    sum += difference;
    squares += std::norm(difference);
  }
  const auto count = static_cast<double>(steps);
  return std::sqrt(std::max(0.0, squares / count - std::norm(sum / count)));
}

/// True if the readings are an integral (dead_reckoning.h).
bool is_integral(const OdometrySteps& readings) {
  constexpr std::size_t kMinReadings = 100;
  constexpr double kMuchLess = 0.2;
  if (readings.rate.size() < kMinReadings) return false;
  double squares = 0.0;
  for (const double step_s : readings.step_s) squares += step_s * step_s;
  const double limit = kMuchLess * odometry_noise(readings.rate) * std::sqrt(squares / 6.0);
  constexpr std::array kShares{0.0, 0.5, 1.0};
  return std::ranges::any_of(kShares, [&](double share) {
    return std::ranges::any_of(kShares, [&](double direction_share) {
      return difference_rms(readings, share, direction_share) < limit;
    });
  });
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
  const auto has = [&](LogChannel channel) { return log[channel].has_value(); };
  if (!has(LogChannel::kHeading)) return;
  if (has(LogChannel::kX) && has(LogChannel::kY) && has(LogChannel::kSpeed) &&
      is_integral(readings_of(log, LogChannel::kX, LogChannel::kY, LogChannel::kSpeed,
                              LogChannel::kHeading))) {
    note_dead_reckoning(log, "x_m, y_m", "speed_mps in the direction of heading_deg", findings);
    log[LogChannel::kX].reset();
    log[LogChannel::kY].reset();
  }
  if (has(LogChannel::kYawRate) &&
      is_integral(readings_of(log, LogChannel::kHeading, {}, LogChannel::kYawRate, {}))) {
    note_dead_reckoning(log, "heading_deg", "yaw_rate_radps", findings);
    log[LogChannel::kHeading].reset();
  }
}

}  // namespace awmr
