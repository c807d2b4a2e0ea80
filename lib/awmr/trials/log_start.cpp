#include "awmr/trials/log_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

template <class T>
void repeat_first(std::vector<T>& values) {
  values.insert(values.begin(), values.front());
}

constexpr std::size_t kReadings = 5;

/// The first kReadings measurements of a channel; fewer if the log has fewer.
std::vector<double> first_readings(const DrivingLog& log, LogChannel channel) {
  std::vector<double> first;
  for (std::size_t row = 0; log[channel] && row < log.rows() && first.size() < kReadings; ++row) {
    if (is_measurement(log, channel, row)) first.push_back(log[channel]->value[row]);
  }
  return first;
}

/// Value, at the first of kReadings equally spaced readings, of the straight line fitted to them.
double first_of_line(const std::vector<double>& y) {
  return 0.6 * y[0] + 0.4 * y[1] + 0.2 * y[2] - 0.2 * y[4];
}

}  // namespace

double largest_measured(const DrivingLog& log, LogChannel channel) {
  double largest = 0.0;
  for (std::size_t row = 0; log[channel] && row < log.rows(); ++row) {
    if (is_measurement(log, channel, row)) {
      largest = std::max(largest, std::abs(log[channel]->value[row]));
    }
  }
  return largest;
}

bool begins_in_motion(const DrivingLog& log) {
  constexpr double kMoves = 0.05;
  return std::ranges::any_of(
      std::array{LogChannel::kSpeed, LogChannel::kYawRate}, [&](LogChannel channel) {
        const std::vector<double> first = first_readings(log, channel);
        if (first.size() < kReadings) return false;
        const double least = kMoves * largest_measured(log, channel);
        return std::abs(median(first)) > least && std::abs(first_of_line(first)) > least;
      });
}

void add_row_of_rest(DrivingLog& log) {
  const bool is_driven = log.force_left.front() != 0.0 || log.force_right.front() != 0.0;
  if (!is_driven || !log[LogChannel::kSpeed] || begins_in_motion(log)) return;
  const double before_s = log.t_s.front() - log.median_step_s();
  repeat_first(log.line);
  log.t_s.insert(log.t_s.begin(), before_s);
  log.force_left.insert(log.force_left.begin(), 0.0);
  log.force_right.insert(log.force_right.begin(), 0.0);
  if (log.steering_command_rad) repeat_first(*log.steering_command_rad);
  for (std::optional<Measured>& channel : log.measured) {
    if (!channel) continue;
    repeat_first(channel->value);
    channel->fresh.insert(channel->fresh.begin(), false);
  }
}

bool has_row_of_rest(const DrivingLog& log) {
  const auto has_force = [&](std::size_t row) {
    return log.force_left[row] != 0.0 || log.force_right[row] != 0.0;
  };
  return log.rows() > 1 && !has_force(0) && has_force(1) &&
         std::ranges::none_of(kChannels, [&](LogChannel c) { return is_measurement(log, c, 0); });
}

}  // namespace awmr
