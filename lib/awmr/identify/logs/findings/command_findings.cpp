#include "awmr/identify/logs/findings/term_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/identify/logs/simulation/steering_linkage.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// A delay, lag or error of commands or sensors that the fit identifies, with its standard error.
struct FoundTerm {
  FreeQuantity quantity;
  double value;
  double error;
};

/// Largest slip ratio at the largest force that is plausible if only the slipping wheels show it.
constexpr double kLargestSlip = 0.25;

/// True if the slip is larger than kLargestSlip, and no position shows that the wheels slip.
bool is_implausible(const FoundTerm& slip, const LogFit& fit) {
  return slip.quantity.kind == Kind::kWheelSlip && slip.quantity.is_ratio &&
         slip.value > kLargestSlip && !has_channel(fit.noise, LogChannel::kX);
}

/// The terms of one kind, acting in all logs, that the fit identifies and that differ significantly
/// from 0, and implausible slip in any case.
std::vector<FoundTerm> found_terms(const LogFit& fit, Kind kind) {
  std::vector<FoundTerm> found;
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    if (fit.quantities[i].kind != kind || fit.quantities[i].log != 0) continue;
    const FoundTerm term{fit.quantities[i], fit.coordinates[i], fit.error_of(i)};
    const bool is_identified = fit.refusal_reason[i].empty() && fit.is_significant(i);
    if (is_identified || is_implausible(term, fit)) found.push_back(term);
  }
  return found;
}

/// Reports the fitted delay of the commands. A positive delay is a dead time. A negative one means
/// that the time stamps of the commands are late. `with_lag`: true if the fit also estimates a
/// motor lag; the message then says that the dead time is in addition to it.
Finding dead_time_finding(const FoundTerm& input, bool with_lag, const std::string& file) {
  if (input.value < 0.0) {
    return {file, 0, Severity::kWarning, "late-commands",
            fmt::format("the vehicle responds {:.3f} +- {:.3f} s before its commands: the time "
                        "stamps of the commands are late, or those of all sensors are early. The "
                        "fit compensates for this; log the commands when they are sent",
                        -input.value, input.error)};
  }
  return {file, 0, Severity::kWarning, "actuator-lag",
          fmt::format("the vehicle responds {:.3f} +- {:.3f} s after its commands, {}. The fit "
                      "compensates for this; add the delay to latency_s of the sensors in the "
                      "vehicle file, so that gains are tuned for it",
                      input.value, input.error,
                      with_lag ? "in addition to the motors' lag"
                               : "which is more likely a dead time than motor lag")};
}

/// True for a time that cannot be distinguished from the unknown times at which commands change
/// between rows (LogFit::change_reach_s). A common delay of all commands, or a lag of the motors,
/// can be an error of these times up to their reach. The delay of one channel relative to the
/// others has an error of at most about an eighth of the row spacing, because the fit is linear in
/// the unknown times.
bool is_within_rows(const FoundTerm& term, const LogFit& fit) {
  constexpr double kShare = 0.25;
  const Kind kind = term.quantity.kind;
  if (kind == Kind::kDelay || (kind == Kind::kMotorLag && fit.change_reach_s > 0.0)) {
    return std::abs(term.value) < fit.change_reach_s + 2.0 * term.error;
  }
  const bool is_relative = kind == Kind::kSensorDelay || kind == Kind::kSteeringDelay;
  return is_relative && fit.change_reach_s > 0.0 &&
         std::abs(term.value) < kShare * fit.change_reach_s + 2.0 * term.error;
}

/// True for a ramp of the forces faster than kShortestRamp_s. It describes other errors in the
/// timing of the commands, so it is not reported as a ramp.
bool is_no_ramp(const FoundTerm& term) {
  return term.quantity.is_ramp() && term.value < kShortestRamp_s;
}

/// True for an exponent of the forces or a slip ratio that is too small to be reported
/// (kMinReported).
bool is_too_small(const FoundTerm& term) {
  const FreeQuantity& q = term.quantity;
  const bool is_share =
      q.kind == Kind::kForceExponent || (q.kind == Kind::kWheelSlip && q.is_ratio);
  return is_share && std::abs(term.value) < kMinReported;
}

/// Reports a motor lag, a dead time or late time stamps of the commands if the fit has found them.
/// Otherwise, if at least two channels are measured and all of them have a latency, reports that
/// actuators or commands are the likely common cause. Times that changes between rows explain are
/// not reported (is_within_rows()): controllers change commands at regular times, so the mean time
/// between two rows can differ from the middle.
std::vector<Finding> actuator_findings(const LogFit& fit, const std::string& file) {
  constexpr std::string_view kWhy =
      "actuator lag, command latency or a slew-rate limit. m', I'z and the sway resistance may be "
      "biased; log the commands that reach the motors, or record slower steps";
  std::vector<Finding> findings;
  for (const FoundTerm& lag : found_terms(fit, Kind::kMotorLag)) {
    if (is_within_rows(lag, fit)) continue;
    findings.push_back(
        {file, 0, Severity::kWarning, "actuator-lag",
         fmt::format("the motors have a lag with a time constant of {:.3f} +- {:.3f} s; the fit "
                     "includes it. Set motor.time_constant_s in the vehicle file to this value",
                     lag.value, lag.error)});
  }
  const bool with_lag = has(fit.quantities, Kind::kMotorLag);
  for (const FoundTerm& input : found_terms(fit, Kind::kDelay)) {
    if (is_within_rows(input, fit)) continue;
    findings.push_back(dead_time_finding(input, with_lag, file));
  }
  if (!findings.empty()) return findings;
  std::vector<FoundTerm> latency = found_terms(fit, Kind::kSensorDelay);
  std::erase_if(latency, [&](const FoundTerm& one) { return is_within_rows(one, fit); });
  std::set<LogChannel> channels;
  for (const LogChannel channel : channels_of(fit.noise)) {
    channels.insert(channel == LogChannel::kY ? LogChannel::kX : channel);
  }
  if (channels.size() < 2 || latency.size() < channels.size()) return {};
  const auto [least, most] = std::ranges::minmax(latency, {}, &FoundTerm::value);
  return {{file, 0, Severity::kWarning, "actuator-lag",
           fmt::format("all sensors appear delayed by {:.3f} to {:.3f} s. A common cause is more "
                       "likely than a delay of each sensor: {}",
                       least.value, most.value, kWhy)}};
}

/// Finding `compass-deviation` about the coefficients of the compass (FreeQuantity::Kind).
std::vector<Finding> compass_findings(const LogFit& fit, const std::string& file) {
  std::vector<std::string> parts;
  for (const auto& [of_sine, of_cosine, cause] :
       {std::tuple(Kind::kCompassSin, Kind::kCompassCos, "once per turn (hard iron)"),
        std::tuple(Kind::kCompassSin2, Kind::kCompassCos2, "twice per turn (soft iron)")}) {
    const Identified amplitude = length_of(identified(fit, of_sine).value_or(Identified{}),
                                           identified(fit, of_cosine).value_or(Identified{}));
    if (!is_significant(amplitude)) continue;
    parts.push_back(fmt::format("{:.1f} +- {:.1f} deg {}", degrees(amplitude.value),
                                degrees(amplitude.error), cause));
  }
  if (parts.empty()) return {};
  return {{file, 0, Severity::kWarning, "compass-deviation",
           fmt::format("the error of heading_deg varies with the heading, as by magnetic parts of "
                       "the vehicle. Amplitude: {}. The fit compensates for this, but simulations "
                       "and tuned gains ignore it; calibrate the compass (awmr compass)",
                       fmt::join(parts, ", "))}};
}

/// Finding `position-sensor` about the antenna or marker (FreeQuantity::Kind::kPositionAhead).
std::vector<Finding> position_findings(const LogFit& fit, const std::string& file) {
  const auto ahead = identified(fit, Kind::kPositionAhead);
  const auto left = identified(fit, Kind::kPositionLeft);
  if (!is_significant(length_of(ahead.value_or(Identified{}), left.value_or(Identified{})))) {
    return {};
  }
  std::vector<std::string> places;
  for (const auto& [distance, positive, negative] :
       {std::tuple(ahead, "ahead of", "behind"),
        std::tuple(left, "to the left of", "to the right of")}) {
    if (!distance) continue;
    places.push_back(fmt::format("{:.3f} +- {:.3f} m {}", std::abs(distance->value),
                                 distance->error, distance->value < 0.0 ? negative : positive));
  }
  const bool has_axle = has(fit.quantities, ExtraForce::kAxleOffset);
  return {{file, 0, Severity::kWarning, "position-sensor",
           fmt::format("x_m and y_m are the position of a point (an antenna or a marker) {} the "
                       "{}. The fit compensates for this, but an autopilot that follows a path "
                       "with these columns leads this point along the path",
                       fmt::join(places, " and "),
                       has_axle ? "middle of the axle" : "centre of gravity")}};
}

std::string sensor_delay_text(const FoundTerm& delay, const LogFit&) {
  const bool is_position = delay.quantity.channel == LogChannel::kX;
  return fmt::format(
      "{} {} delayed by {:.3f} +- {:.3f} s relative to the commands. The fit compensates for this "
      "delay; set latency_s in the vehicle file, so that the gains are tuned for the delay",
      is_position ? "the position" : info(delay.quantity.channel).name,
      is_position ? "comes" : "is read", delay.value, delay.error);
}

std::string averaging_text(const FoundTerm& time, const LogFit&) {
  return fmt::format(
      "{} is the mean of the last {:.3f} +- {:.3f} s, as if a program divided counts or an angle "
      "by this time. The fit takes this into account; add half of this time to latency_s in the "
      "vehicle file, so that the gains are tuned for the delay",
      info(time.quantity.channel).name, time.value, time.error);
}

std::string sensor_lag_text(const FoundTerm& lag, const LogFit& fit) {
  const auto damping = fit.value_of(free_term(Kind::kLagDamping, lag.quantity.channel).name());
  return fmt::format(
      "{} was low-pass filtered before it was logged, with a time constant of {:.3f} "
      "+- {:.3f} s{}. The fit estimates this time constant together with the parameters, "
      "which makes their intervals wider: for narrower intervals, log the unfiltered "
      "reading, or use a filter with a shorter time constant",
      info(lag.quantity.channel).name, lag.value, lag.error,
      damping ? fmt::format(" (second order, damping {:.2g})", *damping) : "");
}

std::string smoothing_text(const FoundTerm& variance_s2, const LogFit&) {
  const double width_s = std::sqrt(variance_s2.value);
  return fmt::format(
      "{} is smoothed over times before and after each row, by a window with a standard "
      "deviation of {:.3f} +- {:.3f} s. The fit estimates this window together with the "
      "parameters, which makes their intervals wider: for narrower intervals, log the "
      "reading itself, without smoothing, interpolation or central differences",
      info(variance_s2.quantity.channel).name, width_s, 0.5 * variance_s2.error / width_s);
}

std::string sensor_scale_text(const FoundTerm& scale, const LogFit&) {
  return fmt::format(
      "{} reads {:.2f} +- {:.2f} % too {}, as {} show. The fit compensates for this; "
      "calibrate the sensor, or map its column divided by {:.4f}",
      info(scale.quantity.channel).name, 100.0 * std::abs(scale.value), 100.0 * scale.error,
      scale.value > 0.0 ? "much" : "little",
      scale.quantity.channel == LogChannel::kSpeed ? "the positions" : "heading or positions",
      1.0 + scale.value);
}

std::string slip_text(const FoundTerm& slip, const LogFit& fit) {
  return fmt::format(
      "the wheels that measure {} slip: at the largest force a wheel rolls faster than it "
      "moves over ground by {}, at smaller forces in proportion less. The fit compensates "
      "for this; measure without driven wheels (optical flow, GNSS, a gyroscope, a free "
      "wheel){}",
      info(slip.quantity.channel).name,
      slip.quantity.is_ratio
          ? fmt::format("{:.1f} +- {:.1f} %", 100.0 * slip.value, 100.0 * slip.error)
          : fmt::format("{:.3f} +- {:.3f} m/s", slip.value, slip.error),
      is_implausible(slip, fit)
          ? ". So much slip is doubtful without a measured position, so all intervals are "
            "withdrawn: a sensor with a longer delay at low speed (speed from the time between two "
            "encoder ticks) has the same effect"
          : "");
}

std::string sway_offset_text(const FoundTerm& one, const LogFit&) {
  return fmt::format(
      "sway_mps is the sideways speed of a point {:.3f} +- {:.3f} m {} the centre "
      "of gravity. The fit compensates for this; mount the sensor at the centre "
      "of gravity, or subtract its distance ahead times the yaw rate",
      std::abs(one.value), one.error, one.value > 0.0 ? "ahead of" : "behind");
}

std::string sway_angle_text(const FoundTerm& one, const LogFit&) {
  return fmt::format(
      "the sensor of sway_mps is turned by {:.2f} +- {:.2f} deg to the {}, so that it shows a part "
      "of the forward speed. The fit compensates for this; align the sensor with the vehicle",
      degrees(std::abs(one.value)), degrees(one.error), one.value > 0.0 ? "left" : "right");
}

std::string speed_offset_text(const FoundTerm& one, const LogFit&) {
  return fmt::format(
      "speed_mps is the forward speed of a point {:.3f} +- {:.3f} m to the {} of the "
      "centre line; at half of the track width, it is the speed of one wheel. The "
      "fit compensates for this; map the mean of a left and a right wheel ({})",
      std::abs(one.value), one.error, one.value > 0.0 ? "left" : "right",
      option_text("column speed_mps=\"(LEFT+RIGHT)/2\""));
}

std::string steering_delay_text(const FoundTerm& latency, const LogFit&) {
  return latency.value > 0.0
             ? fmt::format(
                   "the steering begins to move {:.3f} +- {:.3f} s after its command, in "
                   "addition to the servo's time constant. The fit compensates for this; "
                   "shorten the servo's frame or bus cycle, or add the delay to "
                   "latency_s of the sensors in the vehicle file",
                   latency.value, latency.error)
             : fmt::format(
                   "the steering moves {:.3f} +- {:.3f} s before its command relative to "
                   "the forces: the time stamps of the steering command are late. The "
                   "fit compensates for this; log each command when it is sent",
                   -latency.value, latency.error);
}

std::string servo_rate_text(const FoundTerm& rate, const LogFit&) {
  return fmt::format(
      "the steering rate is limited to {:.1f} +- {:.1f} deg/s; the fit uses this "
      "limit in place of that of the vehicle file. Set steering.max_rate_degps in "
      "the vehicle file to this value",
      degrees(rate.value), degrees(rate.error));
}

std::string dead_band_text(const FoundTerm& band, const LogFit&) {
  return fmt::format(
      "steering commands below {:.2f} +- {:.2f} deg do not move the wheels, and larger "
      "commands move them by this angle less. The fit compensates for this, but simulations "
      "and tuned gains ignore it; reduce the play of the linkage. Or increase the magnitude of "
      "every command by {:.2f} deg before it is sent, and log the commands without this "
      "increase",
      degrees(band.value), degrees(band.error), degrees(band.value));
}

std::string asymmetry_text(const FoundTerm& asymmetry, const LogFit&) {
  return fmt::format(
      "at equal commands the wheels steer {:.1f} +- {:.1f} % further to the {} than the mean "
      "of both sides. The fit compensates for this, but simulations and tuned gains ignore it; "
      "adjust the linkage",
      100.0 * std::abs(asymmetry.value), 100.0 * asymmetry.error,
      asymmetry.value > 0.0 ? "left" : "right");
}

std::string curve_text(const FoundTerm& curve, const LogFit& fit) {
  return fmt::format(
      "the steering linkage is curved: at the stop the wheels steer {:.1f} +- {:.1f} % {} than "
      "in proportion to small commands. The fit compensates for this, but simulations and tuned "
      "gains ignore it{}; log the measured angle as steering_deg",
      100.0 * std::abs(curve.value), 100.0 * curve.error,
      curve.value > 0.0 ? "further" : "less far",
      is_much_curved(fit) ? " (the yaw resistance gets no intervals, because the true form of the "
                            "curve is unknown)"
                          : "");
}

std::string steering_scale_text(const FoundTerm& scale, const LogFit&) {
  return fmt::format(
      "the wheels steer to {:.3f} +- {:.3f} times the logged commands, in addition to the "
      "curve or asymmetry of the linkage. The fit compensates for this, but simulations and "
      "tuned gains ignore it; map steering_cmd_deg to the angle of the wheels, or log the "
      "measured angle as steering_deg",
      1.0 + scale.value, scale.error);
}

std::string trim_text(const FoundTerm& trim, const LogFit& fit) {
  return fmt::format(
      "the vehicle turns as if the front wheels pointed {:.2f} +- {:.2f} deg to "
      "the {} at a steering angle of 0; the fit compensates for this. Centre the "
      "linkage or the servo{}",
      degrees(std::abs(trim.value)), degrees(trim.error), trim.value > 0.0 ? "left" : "right",
      has(fit.quantities, Kind::kForceImbalance)
          ? ""
          : ". If the left and right commands are always equal, motors that are "
            "stronger on one side have the same effect");
}

/// Largest difference of left and right forces of real motors, relative to their mean.
constexpr double kLargestMotorDifference = 0.25;

/// Advice for a force imbalance. `has_trim`: the fit also has a steering trim. Without one, the
/// advice names unequal wheels as another possible cause.
std::string imbalance_advice(double imbalance, bool has_trim) {
  if (std::abs(imbalance) > kLargestMotorDifference) {
    return fmt::format(
        ". Motors rarely differ by more than {:.0f} %, so the intervals are withdrawn. Check "
        "whether speed_mps is the speed of one wheel (use the mean of a left and a right wheel), "
        "and the columns of the left and right forces",
        100.0 * kLargestMotorDifference);
  }
  return fmt::format("; the fit compensates for this. Calibrate the motors of each side{}",
                     has_trim ? "" : "; wheels of unequal size have the same effect");
}

std::string imbalance_text(const FoundTerm& imbalance, const LogFit& fit) {
  return fmt::format(
      "at equal commands the {} wheels push {:.1f} +- {:.1f} % more than the mean of both "
      "sides{}",
      imbalance.value > 0.0 ? "right" : "left", 100.0 * std::abs(imbalance.value),
      100.0 * imbalance.error,
      imbalance_advice(imbalance.value, has(fit.quantities, Kind::kSteeringTrim)));
}

std::string dead_zones_text(const FoundTerm& half, const LogFit&) {
  const bool is_right = half.value > 0.0;
  return fmt::format(
      "the dead zone of the {} motors (commands that give no force) is larger by {:.3f} +- {:.2g} "
      "of the largest force than that of the {} motors. The fit compensates for this, but "
      "simulations and tuned gains assume equal motors. Add this amount to the magnitude of every "
      "nonzero command to the {} motors before it is sent, and log the commands without it",
      is_right ? "right" : "left", 2.0 * std::abs(half.value), 2.0 * half.error,
      is_right ? "left" : "right", is_right ? "right" : "left");
}

/// Largest loss of force, as a share of the force without saturation, at which the messages call
/// the forces proportional to the commands.
constexpr double kLinear = 0.05;

/// Part of a message about a nonlinear force: says that intervals are withdrawn, if they are.
std::string_view without_intervals(const LogFit& fit) {
  return saturates_much(fit)
             ? " (the values get no intervals and parts of the logs are not compared, because the "
               "true form of the saturation is unknown)"
             : "";
}

std::string exponent_text(const FoundTerm& exponent, const LogFit& fit) {
  const double p = exponent.quantity.value(exponent.value);
  return fmt::format(
      "the wheel force is proportional to the command to the power of {:.3f} +- {:.3f}: "
      "{} commands give less force than in proportion{}. The fit compensates for this{}, "
      "but simulations and tuned gains assume proportional forces. As the force, record "
      "the command raised to the power of {:.2f}, with its sign",
      p, p * exponent.error, p < 1.0 ? "large" : "small",
      p < 1.0 ? "" : ", as with a throttle curve (\"expo\")", without_intervals(fit), p);
}

std::string saturation_text(const FoundTerm& loss, const LogFit& fit) {
  const double n = fit.value_of(Kind::kSaturationSharpness).value_or(kDefaultSharpness);
  const double full = loss.quantity.full_command;
  const double s = std::pow(1.0 - loss.value, -n) - 1.0;
  const double linear = full * std::pow((std::pow(1.0 - kLinear, -n) - 1.0) / s, 1.0 / n);
  return fmt::format(
      "at the largest command of the logs, {:.3g}, the wheels push {:.1f} +- {:.1f} % "
      "less than in proportion to small commands: tyres slip, or the current or voltage "
      "of the motors is limited. The fit compensates for this{}, but simulations and "
      "tuned gains assume proportional forces, which is right within {:.0f} % for "
      "commands up to {:.2g}. Limit wheel_force in the vehicle file to this command, and "
      "record logs below it",
      full, 100.0 * loss.value, 100.0 * loss.error, without_intervals(fit), 100.0 * kLinear,
      std::min(linear, full));
}

std::string sag_text(const FoundTerm& loss, const LogFit& fit) {
  return fmt::format(
      "if both sides have the largest command of the logs, {:.3g}, the wheels push {:.1f} +- "
      "{:.1f} % less than in proportion to small commands, and the command of each side reduces "
      "the force of the other: the voltage of the common battery drops. The fit compensates for "
      "this{}, but simulations and tuned gains assume proportional forces. Use a battery with less "
      "internal resistance, or divide the commands by the measured voltage",
      loss.quantity.full_command, 100.0 * loss.value, 100.0 * loss.error, without_intervals(fit));
}

std::string run_on_text(const FoundTerm& share, const LogFit& fit) {
  return fmt::format(
      "{:.0f} +- {:.0f} % of the force of a motor remain when its command becomes 0, and then "
      "decay with the motor's lag. The fit compensates for this{}, but simulations and tuned gains "
      "assume that the force ends at once{}",
      100.0 * share.value, 100.0 * share.error, without_intervals(fit),
      has_dead_zone_of_unknown_place(fit)
          ? ". The dead zone may act before or behind this lag, which gives different values"
          : "");
}

std::string ramp_text(const FoundTerm& time, const LogFit&) {
  return fmt::format(
      "the force of a motor {} by at most {:.2f} +- {:.2f} of F_max per second: a controller ramps "
      "the commands (soft start, slew-rate limit). The fit compensates for this, but simulations "
      "and tuned gains ignore it; switch the ramp off, or log the commands behind it",
      time.quantity.kind == Kind::kForceRise ? "rises" : "falls", 1.0 / time.value,
      time.error / (time.value * time.value));
}

/// Finding about the terms of one kind.
struct TermFinding {
  Kind kind;
  const char* code;
  std::string (*text)(const FoundTerm&, const LogFit&);
};

/// In the order of the findings in model.json. Delay and lag of all commands: actuator_findings().
constexpr TermFinding kTermFindings[] = {
    {Kind::kSensorDelay, "sensor-delay", sensor_delay_text},
    {Kind::kAveraging, "averaged-channel", averaging_text},
    {Kind::kSensorLag, "sensor-lag", sensor_lag_text},
    {Kind::kSmoothing, "smoothed-channel", smoothing_text},
    {Kind::kSensorScale, "sensor-scale", sensor_scale_text},
    {Kind::kWheelSlip, "wheel-slip", slip_text},
    {Kind::kSwayOffset, "sway-sensor", sway_offset_text},
    {Kind::kSwayAngle, "sway-sensor", sway_angle_text},
    {Kind::kSpeedOffset, "speed-sensor", speed_offset_text},
    {Kind::kSteeringDelay, "steering-delay", steering_delay_text},
    {Kind::kServoRate, "servo-rate", servo_rate_text},
    {Kind::kSteeringDeadBand, "steering-dead-band", dead_band_text},
    {Kind::kSteeringAsymmetry, "steering-asymmetry", asymmetry_text},
    {Kind::kSteeringCurve, "steering-curve", curve_text},
    {Kind::kSteeringScale, "steering-scale", steering_scale_text},
    {Kind::kSteeringTrim, "steering-trim", trim_text},
    {Kind::kForceRise, "force-ramp", ramp_text},
    {Kind::kForceFall, "force-ramp", ramp_text},
    {Kind::kForceImbalance, "force-imbalance", imbalance_text},
    {Kind::kDeadZoneDifference, "unequal-dead-zones", dead_zones_text},
    {Kind::kForceExponent, "force-saturation", exponent_text},
    {Kind::kForceSaturation, "force-saturation", saturation_text},
    {Kind::kSupplySag, "force-saturation", sag_text},
    {Kind::kRunOn, "motor-run-on", run_on_text}};

}  // namespace

bool has_implausible_term(const LogFit& fit) {
  const auto is_of_wheel = [](const FoundTerm& imbalance) {
    return std::abs(imbalance.value) > kLargestMotorDifference;
  };
  const auto is_of_sensor = [&](const FoundTerm& slip) { return is_implausible(slip, fit); };
  return std::ranges::any_of(found_terms(fit, Kind::kForceImbalance), is_of_wheel) ||
         std::ranges::any_of(found_terms(fit, Kind::kWheelSlip), is_of_sensor);
}

bool has_dead_zone_of_unknown_place(const LogFit& fit) {
  return has(fit.quantities, Kind::kRunOn) && has(fit.quantities, ParameterId::kWheelDeadZone);
}

bool saturates_much(const LogFit& fit) {
  return fit.value_of(Kind::kForceSaturation).value_or(0.0) > kLinear ||
         fit.value_of(Kind::kSupplySag).value_or(0.0) > kLinear ||
         std::abs(1.0 - fit.value_of(Kind::kForceExponent).value_or(1.0)) > kLinear;
}

std::vector<Finding> command_and_sensor_findings(const LogFit& fit, bool withdrawn,
                                                 const std::vector<DrivingLog>& logs) {
  const std::string& file = logs.front().file;
  std::vector<Finding> findings;
  for (const TermFinding& one : kTermFindings) {
    for (const FoundTerm& term : found_terms(fit, one.kind)) {
      if (is_within_rows(term, fit) || is_no_ramp(term) || is_too_small(term)) continue;
      const bool is_convex = one.kind == Kind::kForceExponent && term.value > 0.0;  // p > 1
      findings.push_back(
          {file, 0, Severity::kWarning, is_convex ? "force-curve" : one.code, one.text(term, fit)});
    }
  }
  for (const auto& more :
       {log_findings(fit, logs), position_findings(fit, file), compass_findings(fit, file),
        actuator_findings(fit, file), force_findings(fit, file)}) {
    append(findings, more);
  }
  if (!withdrawn) return findings;
  for (Finding& finding : findings) {
    const bool is_of_curve = finding.code == "force-saturation" || finding.code == "force-curve";
    if (is_of_curve && saturates_much(fit)) continue;
    finding.message +=
        ". This value has no interval, because the intervals of this fit are withdrawn: a wrong "
        "model of the vehicle may have caused the value. Before you change the vehicle, remove the "
        "reason for which a finding withdraws the intervals";
  }
  return findings;
}

}  // namespace awmr
