/// Names of fitted errors of the commands, and of a sensor's delay and filter time constant, in
/// /estimates.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kSteeringTrimName = "steering.trim_rad";
inline constexpr std::string_view kForceImbalanceName = "motor.imbalance";
inline constexpr std::string_view kSensorDelayPrefix = "delay.";  ///< + the channel's column
inline constexpr std::string_view kSensorLagPrefix = "lag.";      ///< + the channel's column

}  // namespace awmr
