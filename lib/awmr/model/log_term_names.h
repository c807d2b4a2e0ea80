/// Names, in /estimates of model.json, of the vehicle and sensor errors that a fit of logs can
/// estimate: steering trim, largest rate of the servo, imbalance of left and right motors,
/// saturation of the forces, Stribeck friction, slope of the ground, delay, filter time constant,
/// smoothing and wheel slip of a sensor.
#pragma once

#include <array>
#include <string_view>

namespace awmr {

inline constexpr std::string_view kSteeringTrimName = "steering.trim_rad";
inline constexpr std::string_view kSteeringDeadBandName = "steering.dead_band_rad";
inline constexpr std::string_view kSteeringAsymmetryName = "steering.asymmetry";
inline constexpr std::string_view kServoRateName = "steering.max_rate_radps";
inline constexpr std::string_view kForceImbalanceName = "motor.imbalance";
inline constexpr std::string_view kForceExponentName = "motor.exponent";
inline constexpr std::string_view kForceSaturationName = "motor.saturation";
inline constexpr std::string_view kSaturationSharpnessName = "motor.saturation_sharpness";
/// Stribeck friction and its speed scale, of the speed and of the yaw rate; acceleration by a
/// slope; surge resistance in turns; excess of forces against the motion, of backward
/// forces, and of the surge resistance backward.
inline constexpr std::array<std::string_view, 12> kExtraForceNames = {
    "surge.stribeck",
    "surge.stribeck_speed_mps",
    "yaw.stribeck",
    "yaw.stribeck_speed_radps",
    "slope.x_mps2",
    "slope.y_mps2",
    "surge.turn_drag",
    "surge.turn_drag_exponent",
    "surge.turn_drag_speed_exponent",
    "motor.brake_excess",
    "motor.reverse_excess",
    "surge.backward_excess"};
inline constexpr std::string_view kSensorDelayPrefix =
    "delay.";  ///< followed by the channel's column name
inline constexpr std::string_view kSensorLagPrefix =
    "lag.";  ///< followed by the channel's column name
inline constexpr std::string_view kSmoothingPrefix =
    "smoothing_s2.";                                      ///< followed by the channel's column name
inline constexpr std::string_view kSlipPrefix = "slip.";  ///< followed by the channel's column name
inline constexpr std::string_view kSlipRatioPrefix =
    "slip_ratio.";  ///< followed by the channel's column name
inline constexpr std::string_view kSwayOffsetName = "sway.offset_m";  ///< of the sway sensor
inline constexpr std::string_view kSwayAngleName = "sway.angle_rad";  ///< of the sway sensor

}  // namespace awmr
