#include "constant_channels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace awmr {
namespace {

struct MotionLimit {
  std::string_view column;
  double least;  ///< smallest value that counts as motion, in the column's unit
  /// True: `least` is compared with the range of the values; false: with their largest magnitude.
  bool is_position;
};
constexpr std::array<MotionLimit, 8> kMotionLimits{{{"x_m", 0.2, true},
                                                    {"y_m", 0.2, true},
                                                    {"latitude_deg", 2e-6, true},
                                                    {"longitude_deg", 2e-6, true},
                                                    {"heading_deg", 5.0, true},
                                                    {"speed_mps", 0.05, false},
                                                    {"sway_mps", 0.05, false},
                                                    {"yaw_rate_radps", 0.1, false}}};
constexpr std::array<LogChannel, 4> kMotionChannels{LogChannel::kHeading, LogChannel::kSpeed,
                                                    LogChannel::kSway, LogChannel::kYawRate};
/// Minimum number of equal values of a constant channel; fewer may be equal by chance.
constexpr std::size_t kMinValues = 10;

bool is_constant(std::span<const double> values) {
  return values.size() >= kMinValues &&
         std::ranges::all_of(values, [&](double value) { return value == values.front(); });
}

bool shows_motion(std::span<const double> values, const MotionLimit& limit) {
  if (values.empty() || is_constant(values)) return false;
  const auto [low, high] = std::ranges::minmax_element(values);
  const double most = limit.is_position ? *high - *low : std::max(std::abs(*low), std::abs(*high));
  return most >= limit.least;
}

}  // namespace

std::vector<ConstantChannel> constant_channels(const ColumnValues& values) {
  const bool is_moving = std::ranges::any_of(kMotionLimits, [&](const MotionLimit& limit) {
    const auto column = values(limit.column);
    return column && shows_motion(*column, limit);
  });
  std::vector<ConstantChannel> found;
  if (!is_moving) return found;
  for (const LogChannel channel : kMotionChannels) {
    const auto column = values(info(channel).column);
    if (column && is_constant(*column)) found.push_back({channel, column->front()});
  }
  return found;
}

}  // namespace awmr
