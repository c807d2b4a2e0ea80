/// Names, in /estimates of model.json, of effects that the model lacks and that a fit of logs can
/// estimate. Steering: trim, dead band, asymmetry, curve, scale, largest rate of the servo. Motors:
/// imbalance of left and right, nonlinear force. Forces on the vehicle: Stribeck friction, slope of
/// the ground, ... Sensors: delay, averaging, filter, smoothing, wheel slip, mounting.
///
/// The name of an effect in only one of several logs ends with kOfLog and the number of the log,
/// for example "motor.force_scale.log_2".
#pragma once

#include <array>
#include <string_view>

namespace awmr {

inline constexpr std::string_view kOfLog = ".log_";
inline constexpr std::string_view kSteeringTrimName = "steering.trim_rad";
inline constexpr std::string_view kSteeringDeadBandName = "steering.dead_band_rad";
inline constexpr std::string_view kSteeringAsymmetryName = "steering.asymmetry";
inline constexpr std::string_view kSteeringCurveName = "steering.curve";
inline constexpr std::string_view kSteeringScaleName = "steering.scale";
inline constexpr std::string_view kServoRateName = "steering.max_rate_radps";
inline constexpr std::string_view kForceImbalanceName = "motor.imbalance";
inline constexpr std::string_view kDeadZoneDifferenceName = "motor.dead_zone_difference";
inline constexpr std::string_view kForceRiseName = "motor.rise_time_s";
inline constexpr std::string_view kForceFallName = "motor.fall_time_s";
inline constexpr std::string_view kForceExponentName = "motor.exponent";
inline constexpr std::string_view kForceSaturationName = "motor.saturation";
inline constexpr std::string_view kSupplySagName = "motor.supply_sag";
inline constexpr std::string_view kRunOnName = "motor.run_on";
inline constexpr std::string_view kForceScaleName = "motor.force_scale";
inline constexpr std::string_view kResistanceScalePrefix =
    "resistance_scale.";  ///< followed by the column name of the speed or yaw rate
inline constexpr std::string_view kSaturationSharpnessName = "motor.saturation_sharpness";
/// Further forces. Stribeck friction (larger friction at low speed) with its speed scale, in surge
/// and in yaw. Acceleration by a slope along x and y. Additional surge resistance in turns, with
/// its exponents. Relative increases of three quantities: motor forces that brake, backward motor
/// forces, and surge resistance in backward motion. The last name is a yaw moment that pulls the
/// driving vehicle to one side.
inline constexpr std::array<std::string_view, 14> kExtraForceNames = {
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
    "surge.backward_excess",
    "yaw.pull_m",
    "axle.offset_m"};
inline constexpr std::string_view kSensorDelayPrefix =
    "delay.";  ///< followed by the channel's column name
inline constexpr std::string_view kAveragingPrefix =
    "averaging.";  ///< followed by the channel's column name
inline constexpr std::string_view kSensorLagPrefix =
    "lag.";  ///< followed by the channel's column name
inline constexpr std::string_view kLagDampingPrefix =
    "lag_damping.";  ///< followed by the channel's column name
inline constexpr std::string_view kSmoothingPrefix =
    "smoothing_s2.";  ///< followed by the channel's column name
inline constexpr std::string_view kSensorScalePrefix =
    "scale.";                                             ///< followed by the channel's column name
inline constexpr std::string_view kSlipPrefix = "slip.";  ///< followed by the channel's column name
inline constexpr std::string_view kSlipRatioPrefix =
    "slip_ratio.";  ///< followed by the channel's column name
inline constexpr std::string_view kSwayOffsetName = "sway.offset_m";        ///< of the sway sensor
inline constexpr std::string_view kSwayAngleName = "sway.angle_rad";        ///< of the sway sensor
inline constexpr std::string_view kSpeedOffsetName = "speed.offset_m";      ///< of the speed sensor
inline constexpr std::string_view kPositionAheadName = "position.ahead_m";  ///< of the antenna
inline constexpr std::string_view kPositionLeftName = "position.left_m";    ///< of the antenna
inline constexpr std::string_view kCompassSinName = "compass.sin_rad";      ///< deviation at 90 deg
inline constexpr std::string_view kCompassCosName = "compass.cos_rad";      ///< deviation at 0 deg
inline constexpr std::string_view kCompassSin2Name = "compass.sin2_rad";    ///< at 45 deg
inline constexpr std::string_view kCompassCos2Name = "compass.cos2_rad";    ///< at 0 and 180 deg

}  // namespace awmr
