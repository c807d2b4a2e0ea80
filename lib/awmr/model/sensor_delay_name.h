/// Names, in /estimates of model.json, of the vehicle and sensor errors that a fit of logs can
/// estimate: steering trim, imbalance of left and right motors, saturation of the forces, delay and
/// filter time constant of a sensor.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kSteeringTrimName = "steering.trim_rad";
inline constexpr std::string_view kForceImbalanceName = "motor.imbalance";
inline constexpr std::string_view kForceSaturationName = "motor.saturation";
inline constexpr std::string_view kSaturationSharpnessName = "motor.saturation_sharpness";
inline constexpr std::string_view kSensorDelayPrefix = "delay.";  ///< + the channel's column
inline constexpr std::string_view kSensorLagPrefix = "lag.";      ///< + the channel's column

}  // namespace awmr
