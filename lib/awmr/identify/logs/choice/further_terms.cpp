#include "awmr/identify/logs/choice/further_terms.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/identify/logs/choice/log_terms.h"
#include "awmr/identify/options.h"
#include "awmr/model/log_term_names.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// Coefficients of the deviation of a compass.
constexpr Kind kCompassTerms[] = {Kind::kCompassSin, Kind::kCompassCos, Kind::kCompassSin2,
                                  Kind::kCompassCos2};

bool any_log(const LogProblem& problem, bool (*has)(const DrivingLog&)) {
  return std::ranges::any_of(problem.windows,
                             [&](const FitWindow& window) { return has(*window.rows.log); });
}

/// Largest force command of the logs, over F_max.
double largest_command(const LogProblem& problem) {
  double largest = 0.0;
  for (const FitWindow& window : problem.windows) {
    const DrivingLog& log = *window.rows.log;
    for (std::size_t row = window.rows.begin; row < window.rows.end; ++row) {
      largest = std::max({largest, std::abs(log.force_left[row]), std::abs(log.force_right[row])});
    }
  }
  return largest;
}

bool has_turns(const LogProblem& problem) {
  return any_log(problem, has_steering_changes) || any_log(problem, has_force_difference);
}

/// True if a channel measures how the vehicle turns.
bool measures_turns(const LogProblem& problem) {
  const NoiseLevels& measured = problem.model.noise;
  return has_channel(measured, LogChannel::kYawRate) ||
         has_channel(measured, LogChannel::kHeading) || has_channel(measured, LogChannel::kX);
}

FreeQuantity term_of(Kind kind) { return free_term(kind); }
FreeQuantity term_of(ExtraForce force) { return extra_force(force); }

/// Adds the term `what` (a Kind or an ExtraForce) if the fit does not contain it yet and the logs
/// can show it.
template <class What>
void add_term(const LogProblem& problem, What what, bool is_shown,
              std::vector<FreeQuantity>& found) {
  if (is_shown && !has(problem.model.quantities, what)) found.push_back(term_of(what));
}

void add_times(const LogProblem& problem, std::vector<FreeQuantity>& found) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  add_term(problem, Kind::kDelay, true, found);
  for (const LogChannel measured : channels_of(problem.model.noise)) {
    const LogChannel channel = measured == LogChannel::kY ? LogChannel::kX : measured;
    if (has_kind(quantities, Kind::kSensorDelay, channel) ||
        has_kind(quantities, Kind::kSensorLag, channel) ||
        has_kind(found, Kind::kSensorDelay, channel)) {
      continue;
    }
    found.push_back(free_term(Kind::kSensorDelay, channel));
  }
  if (found.size() == 1) found.clear();
  for (const LogChannel channel : channels_of(problem.model.noise)) {
    if (is_often_filtered(channel) && !has_kind(quantities, Kind::kSensorLag, channel) &&
        !has_kind(quantities, Kind::kAveraging, channel) &&
        !has_kind(quantities, Kind::kSmoothing, channel)) {
      found.push_back(smoothing_of(channel));
    }
  }
}

/// True if the log has forces of more than 1 % of F_max in both directions.
bool has_both_directions(const DrivingLog& log) {
  constexpr double kLeast = 0.01;
  const auto any = [&](auto is_so) {
    return std::ranges::any_of(log.force_left, is_so) ||
           std::ranges::any_of(log.force_right, is_so);
  };
  return any([](double f) { return f > kLeast; }) && any([](double f) { return f < -kLeast; });
}

/// Adds those forces of extra_forces.h that the fit does not contain and that the logs can show:
///   - Stribeck friction, if the resistance has Coulomb friction;
///   - a slope, if heading or position is measured;
///   - a side pull, if yaw rate, heading or position is measured;
///   - drag in turns, if the commands turn the vehicle;
///   - a centre of gravity ahead of the axle, if left and right forces differ;
///   - a different resistance backward, if the log has forces in both directions;
///   - an excess of braking or of backward forces, if the log has forces in both directions. A fit
///     contains at most one of the two.
void add_forces(const LogProblem& problem, std::vector<FreeQuantity>& found) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  for (const auto& [force, coulomb] :
       {std::pair(ExtraForce::kSurgeStribeck, ParameterId::kSurgeCoulomb),
        std::pair(ExtraForce::kYawStribeck, ParameterId::kYawCoulomb)}) {
    add_term(problem, force, has(quantities, coulomb), found);
  }
  const bool has_heading = has_channel(problem.model.noise, LogChannel::kHeading) ||
                           has_channel(problem.model.noise, LogChannel::kX);
  if (has_heading && !has(quantities, ExtraForce::kSlopeX)) {
    found.push_back(extra_force(ExtraForce::kSlopeX));
    found.push_back(extra_force(ExtraForce::kSlopeY));
  }
  add_term(problem, ExtraForce::kSidePull, measures_turns(problem), found);
  add_term(problem, ExtraForce::kTurnDrag, has_turns(problem), found);
  add_term(problem, ExtraForce::kAxleOffset, any_log(problem, has_force_difference), found);
  if (!any_log(problem, has_both_directions)) return;
  // A fit contains either wheel slip or an excess of wheel forces, because the slip of wheel_slip.h
  // does not include this excess.
  if (!has_force_excess(quantities) && !has(quantities, Kind::kWheelSlip)) {
    found.push_back(extra_force(ExtraForce::kBrakeForce));
    found.push_back(extra_force(ExtraForce::kReverseForce));
  }
  add_term(problem, ExtraForce::kBackwardDrag, true, found);
}

void add_scales(const LogProblem& problem, std::vector<FreeQuantity>& found) {
  const NoiseLevels& measured = problem.model.noise;
  const bool has_position = has_channel(measured, LogChannel::kX);
  const bool has_heading = has_position || has_channel(measured, LogChannel::kHeading);
  for (const auto& [channel, is_shown] : {std::pair(LogChannel::kYawRate, has_heading),
                                          std::pair(LogChannel::kSpeed, has_position)}) {
    if (!is_shown || !has_channel(measured, channel)) continue;
    if (has_kind(problem.model.quantities, Kind::kSensorScale, channel)) continue;
    found.push_back(free_term(Kind::kSensorScale, channel));
  }
}

/// Adds the slip of the wheels that measure speed or yaw rate. The slip has two forms, a speed or a
/// ratio (WheelSlip::is_ratio). If the fit already has slip of one channel, the other channel gets
/// only the same form.
void add_slip(const LogProblem& problem, std::vector<FreeQuantity>& found) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  if (has_force_excess(quantities)) return;
  const auto other = place_of(quantities, Kind::kWheelSlip);
  for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    if (!has_channel(problem.model.noise, channel) ||
        has_kind(quantities, Kind::kWheelSlip, channel))
      continue;
    if (channel == LogChannel::kYawRate && !any_log(problem, has_force_difference)) continue;
    for (const bool is_ratio : {false, true}) {
      if (other && quantities[*other].is_ratio != is_ratio) continue;
      found.push_back(wheel_slip_of(channel, is_ratio));
    }
  }
}

void add_steering(const LogProblem& problem, std::vector<FreeQuantity>& found) {
  if (!any_log(problem, has_steering_changes)) return;
  const auto has_command = [](const DrivingLog& log) {
    return log.steering_command_rad.has_value();
  };
  for (const Kind kind : {Kind::kSteeringTrim, Kind::kSteeringDeadBand, Kind::kSteeringAsymmetry,
                          Kind::kSteeringCurve}) {
    add_term(problem, kind, kind == Kind::kSteeringTrim || any_log(problem, has_command), found);
  }
  const bool leaves_scale_open = has(problem.model.quantities, Kind::kSteeringAsymmetry) ||
                                 has(problem.model.quantities, Kind::kSteeringCurve);
  add_term(problem, Kind::kSteeringScale, leaves_scale_open, found);
}

/// Initial guess of a term. A term that cannot be negative begins above 0, so that the search can
/// increase and decrease it.
double begin_of(const FreeQuantity& quantity) {
  constexpr double kShare = 0.2;
  return quantity.may_be_zero() ? kShare * quantity.large_change : 0.0;
}

/// Every term that a user can request by name. The other terms cannot be free from the start of a
/// fit: they need a value from the logs (the largest command or speed, or the rate of the servo),
/// or another term in the fit.
std::vector<FreeQuantity> all_terms() {
  std::vector<FreeQuantity> terms;
  for (const Kind kind :
       {Kind::kDelay, Kind::kSteeringDelay, Kind::kMotorLag, Kind::kForceRise, Kind::kForceFall,
        Kind::kSteeringTrim, Kind::kSteeringDeadBand, Kind::kSteeringAsymmetry,
        Kind::kSteeringCurve, Kind::kForceImbalance, Kind::kForceExponent, Kind::kSwayOffset,
        Kind::kSwayAngle, Kind::kSpeedOffset, Kind::kPositionAhead, Kind::kPositionLeft}) {
    terms.push_back(free_term(kind));
  }
  for (const Kind kind : kCompassTerms) terms.push_back(free_term(kind));
  for (const ExtraForce force : {ExtraForce::kSlopeX, ExtraForce::kSlopeY, ExtraForce::kBrakeForce,
                                 ExtraForce::kReverseForce, ExtraForce::kBackwardDrag,
                                 ExtraForce::kSidePull, ExtraForce::kAxleOffset}) {
    terms.push_back(extra_force(force));
  }
  for (const LogChannel channel : kChannels) {
    // x and y have one delay together.
    if (channel != LogChannel::kY) terms.push_back(free_term(Kind::kSensorDelay, channel));
    if (!is_often_filtered(channel)) continue;
    terms.push_back(sensor_lag_of(channel));
    terms.push_back(smoothing_of(channel));
    if (channel == LogChannel::kHeading) continue;
    terms.push_back(free_term(Kind::kAveraging, channel));
    terms.push_back(free_term(Kind::kSensorScale, channel));
    for (const bool is_ratio : {false, true}) terms.push_back(wheel_slip_of(channel, is_ratio));
  }
  return terms;
}

void add_ramps(const std::vector<FreeQuantity>& quantities, std::vector<FreeQuantity>& found) {
  for (const FreeQuantity& ramp :
       {force_rise(false), force_rise(true), free_term(Kind::kForceFall)}) {
    if (!has(quantities, ramp.kind)) found.push_back(ramp);
  }
}

/// Errors of the forces that the motors make.
void add_motors(const LogProblem& problem, std::vector<FreeQuantity>& found) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const bool has_difference = any_log(problem, has_force_difference);
  add_term(problem, Kind::kForceImbalance, has_difference, found);
  add_term(problem, Kind::kDeadZoneDifference,
           has_difference && has(quantities, ParameterId::kWheelDeadZone), found);
  const LogModel& model = problem.model;
  const bool has_lag = model.vehicle.motor_time_constant_s || has(quantities, Kind::kMotorLag);
  const bool has_back_emf =
      has(quantities, ParameterId::kBackEmf) || model.held[at(ParameterId::kBackEmf)] > 0.0;
  add_term(problem, Kind::kRunOn, has_lag && has_back_emf, found);
  const double full_command = largest_command(problem);
  if (full_command > 0.0) add_ramps(quantities, found);
  // A fit contains only one of an exponent, a saturation and a supply sag of the forces. Together
  // they could fit every curve, even one with wrong forces at small commands.
  if (full_command > 0.0 && !has(quantities, Kind::kForceExponent) &&
      !has(quantities, Kind::kForceSaturation) && !has(quantities, Kind::kSupplySag)) {
    found.push_back(free_term(Kind::kForceExponent));
    found.push_back(force_saturation(full_command));
    if (has_difference) found.push_back(supply_sag(full_command));
  }
}

}  // namespace

bool is_often_filtered(LogChannel channel) {
  return channel == LogChannel::kSpeed || channel == LogChannel::kYawRate ||
         channel == LogChannel::kHeading;
}

bool is_often_counted(LogChannel channel) {
  return channel == LogChannel::kSpeed || channel == LogChannel::kYawRate;
}

std::vector<FreeQuantity> further_terms(const LogProblem& problem) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  std::vector<FreeQuantity> found;
  add_times(problem, found);
  // If the fit had no delay of the steering, the free time constant of the servo would absorb the
  // servo's dead time.
  add_term(problem, Kind::kSteeringDelay, has(quantities, ParameterId::kSteeringTimeConstant),
           found);
  add_steering(problem, found);
  const FreeQuantity gyro_bias = free_term(Kind::kBias, LogChannel::kYawRate);
  if (has_channel(problem.model.noise, LogChannel::kYawRate) &&
      !has(quantities, gyro_bias.name())) {
    found.push_back(gyro_bias);
  }
  append(found, further_log_terms(problem));
  add_motors(problem, found);
  for (const ParameterId coulomb : problem.optional_coulomb) {
    if (!has(quantities, coulomb)) found.push_back(free_parameter(coulomb));
  }
  add_forces(problem, found);
  add_scales(problem, found);
  add_slip(problem, found);
  const NoiseLevels& measured = problem.model.noise;
  for (const Kind kind : {Kind::kSwayOffset, Kind::kSwayAngle}) {
    add_term(problem, kind, has_channel(measured, LogChannel::kSway), found);
  }
  add_term(
      problem, Kind::kSpeedOffset,
      has_channel(measured, LogChannel::kSpeed) && measures_turns(problem) && has_turns(problem),
      found);
  for (const Kind kind : {Kind::kPositionAhead, Kind::kPositionLeft}) {
    add_term(problem, kind, has_channel(measured, LogChannel::kX) && has_turns(problem), found);
  }
  for (const Kind kind : kCompassTerms) {
    add_term(problem, kind, has_channel(measured, LogChannel::kHeading), found);
  }
  return found;
}

std::vector<std::string> requestable_terms() {
  std::vector<std::string> names;
  for (const FreeQuantity& term : all_terms()) names.push_back(term.name());
  return names;
}

std::vector<std::string> automatic_terms() {
  std::vector<std::string> names{std::string(kServoRateName),
                                 std::string(kSteeringScaleName),
                                 std::string(kForceSaturationName),
                                 std::string(kSupplySagName),
                                 std::string(kDeadZoneDifferenceName),
                                 std::string(kSaturationSharpnessName),
                                 std::string(kRunOnName)};
  for (const LogChannel channel : kChannels) {
    if (!is_often_filtered(channel)) continue;
    names.push_back(free_term(Kind::kLagDamping, channel).name());
  }
  const std::vector<std::string> requestable = requestable_terms();
  for (const std::string_view name : kExtraForceNames) {
    if (!contains(requestable, name)) names.emplace_back(name);
  }
  return names;
}

std::vector<FreeTerm> requested_terms(std::span<const std::string> names) {
  std::vector<FreeTerm> terms;
  for (const FreeQuantity& term : all_terms()) {
    if (contains(names, term.name())) terms.push_back({term, begin_of(term)});
  }
  return terms;
}

}  // namespace awmr
