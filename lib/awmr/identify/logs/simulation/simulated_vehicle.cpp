#include "awmr/identify/logs/simulation/simulated_vehicle.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/units.h"
#include "awmr/model/sliding.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// Raises a servo time constant below h/2 to h/2, the shortest that Runge-Kutta steps of h seconds
/// resolve. With a shorter time constant, which a search may try, the integration would diverge.
/// Also removes the column of the time constant, which then has no effect.
void slow_servo(double h, std::vector<ParameterColumn>& parameters, Plant<double>& plant) {
  if (!(plant.steering_time_constant_s < 0.5 * h)) return;
  plant.steering_time_constant_s = 0.5 * h;
  std::erase_if(parameters, [](const ParameterColumn& column) {
    return column.id == ParameterId::kSteeringTimeConstant;
  });
}

/// Symmetric smoothing of a channel by a kernel with the variance `variance_s2`, s^2.
Smoothing smoothing_at(const FitWindow& window, const FreeQuantity& quantity, double variance_s2,
                       std::size_t column) {
  const double rows2_per_s2 = std::pow(window.row_spacing_s, -2);
  const double variance = variance_s2 * rows2_per_s2;
  return {quantity.is_mean ? moving_average(variance) : gaussian_kernel(variance), column,
          rows2_per_s2};
}

/// Sets the part of the command path that the quantity `q` describes, if any. `number`: its value;
/// `i`: its column.
void set_command_term(const FreeQuantity& q, double number, std::size_t i, const FitWindow& window,
                      CommandPath& path) {
  const DrivingLog& log = *window.rows.log;
  const bool has_command = log.steering_command_rad.has_value();
  if (q.is_beyond_stop && has_command) path.stop_limits_command = true;
  if (q.kind == Kind::kParameter || q.kind > kLastOfCommands) return;
  if (q.is_of_linkage() && q.kind != Kind::kSteeringTrim && !has_command) return;
  path.terms[q.kind] = {number, i};
  if (q.kind == Kind::kMotorLag) path.lag.emplace(log, window.rows.begin, window.rows.end, number);
  if (q.kind == Kind::kForceRise) path.terms.turns_slowly = q.turns_slowly;
  if (q.kind == Kind::kForceSaturation || q.kind == Kind::kSupplySag) {
    path.full_command = q.full_command;
  }
}

/// Does the same for the sensor error that `q` describes, if any.
void set_sensor_term(const FreeQuantity& q, double number, std::size_t i, const FitWindow& window,
                     SensorTerms& sensors) {
  const std::size_t c = at(q.channel);
  switch (q.kind) {
    case Kind::kSensorLag:
      sensors.lag[c] = {{number, i}, q.is_at_rows, {}};
      break;
    case Kind::kLagDamping:
      sensors.lag_damping[c] = {number, i};
      break;
    case Kind::kSmoothing:
      sensors.smoothing[c] = smoothing_at(window, q, number, i);
      break;
    case Kind::kSensorDelay:
      sensors.delay[c] = {number, i};
      if (q.channel == LogChannel::kX) sensors.delay[at(LogChannel::kY)] = {number, i};
      break;
    case Kind::kAveraging:
      sensors.averaging[c] = {number, i};
      break;
    case Kind::kSensorScale:
      sensors.scale[c] = {number, i};
      break;
    case Kind::kWheelSlip:
      sensors.slips.push_back({q.channel, {number, i}, q.is_ratio});
      break;
    case Kind::kBias:
      sensors.biases.emplace_back(q.channel, TermColumn{number, i});
      break;
    default:
      if (q.kind >= Kind::kSwayOffset) sensors.mounting[q.kind] = {number, i};
  }
}

/// Sets the motor lag of the vehicle file, unless the fit estimates one, and the ramps of the
/// forces (CommandPath::ramps).
void set_motor_dynamics(const LogModel& model, const FitWindow& window, CommandPath& path) {
  const DrivingLog& log = *window.rows.log;
  const auto [begin, end] = std::pair(window.rows.begin, window.rows.end);
  const double given_lag_s = model.vehicle.motor_time_constant_s.value_or(0.0);
  if (!path.lag && given_lag_s > 0.0) path.lag.emplace(log, begin, end, given_lag_s);
  const CommandTerms& terms = path.terms;
  if (!terms[Kind::kForceRise] && !terms[Kind::kForceFall]) return;
  const RampTimes times{.rise_s = terms.value(Kind::kForceRise),
                        .fall_s = terms.value(Kind::kForceFall),
                        .lag_s = path.lag ? path.lag->time_constant_s() : 0.0,
                        .turns_slowly = terms.turns_slowly};
  // Without ramps and lag, LinearStepper::change_command() treats the jumps of the forces.
  const bool has_ramp = times.rise_s > 0.0 || times.fall_s > 0.0;
  if (!has_ramp && !path.lag && terms[Kind::kDelay]) return;
  path.ramps.emplace(log, begin, end, times);
}

/// Multiplies the resistance of one axis by 1 + e: its parameters in `values`, and the derivatives
/// in `parameters`, to which it adds those with respect to e. `i`: column of e.
void scale_resistance(LogChannel axis, double e, std::size_t i, ParameterValues<double>& values,
                      std::vector<ParameterColumn>& parameters) {
  for (const ParameterId id : resistance_of(axis)) {
    for (ParameterColumn& column : parameters) {
      if (column.id == id) column.factor *= 1.0 + e;
    }
    parameters.push_back({id, i, values[at(id)]});
    values[at(id)] *= 1.0 + e;
  }
}

/// Sets the parameters, further forces, commands and sensors of `vehicle` from the free quantities
/// of the model. Returns the values of all parameters, free and fixed.
ParameterValues<double> set_quantities(const LogModel& model, const FitWindow& window,
                                       const double* coordinates, SimulatedVehicle& vehicle) {
  ParameterValues<double> values = model.held;
  for (std::size_t i = 0; i < model.quantities.size(); ++i) {
    const FreeQuantity& q = model.quantities[i];
    if (!q.acts_in(*window.rows.log)) continue;
    const double number = q.value(coordinates[i]);
    if (q.kind == Kind::kParameter) {
      values[at(q.id)] = number;
      vehicle.parameters.push_back({q.id, i, q.jacobian(coordinates[i])});
    } else if (q.kind == Kind::kExtraForce) {
      vehicle.extra[q.force] = number;
      vehicle.extra.columns.push_back({q.force, i, q.jacobian(coordinates[i])});
    }
    if (auto& delay = vehicle.path.terms[Kind::kDelay]; q.kind == Kind::kDelay && delay) {
      delay->value += number;
      vehicle.equal_columns.emplace_back(delay->column, i);
      continue;
    }
    set_command_term(q, number, i, window, vehicle.path);
    set_sensor_term(q, number, i, window, vehicle.sensors);
  }
  for (std::size_t i = 0; i < model.quantities.size(); ++i) {
    const FreeQuantity& q = model.quantities[i];
    if (q.kind != Kind::kResistanceScale || !q.acts_in(*window.rows.log)) continue;
    scale_resistance(q.channel, coordinates[i], i, values, vehicle.parameters);
  }
  return values;
}

/// Sets the plant of `vehicle` with these parameter values, resolved by the model's longest step.
void set_plant(const LogModel& model, const FitWindow& window,
               const ParameterValues<double>& values, SimulatedVehicle& vehicle) {
  Plant<double>& plant = vehicle.plant;
  plant = resolved_beside_friction(plant_of(model.vehicle, values), model.longest_step_s);
  plant.steering_max_rate_radps =
      vehicle.path.terms.value(Kind::kServoRate, plant.steering_max_rate_radps);
  slow_servo(model.longest_step_s, vehicle.parameters, plant);
  // A logged steering angle is used as it is, without the steering limit of the vehicle. If the
  // stop limits the command, it does not limit the angle.
  if (!window.rows.log->steering_command_rad || vehicle.path.stop_limits_command) {
    plant.steering_max_rad = 10.0;
  }
}

}  // namespace

bool SensorTerms::any_earlier() const {
  const auto is_free = [](const auto& one) { return one.has_value(); };
  return std::ranges::any_of(delay, is_free) || std::ranges::any_of(averaging, is_free);
}

bool SensorTerms::any_smoothed() const {
  return std::ranges::any_of(smoothing, [](const auto& one) { return one.has_value(); });
}

SimulatedVehicle vehicle_at(const LogModel& model, const FitWindow& window,
                            const double* coordinates, const double* initial_state) {
  SimulatedVehicle vehicle{};
  vehicle.path.steering_stop_rad = radians(model.vehicle.steering_max_deg);
  const ParameterValues<double> values = set_quantities(model, window, coordinates, vehicle);
  set_motor_dynamics(model, window, vehicle.path);
  vehicle.extra.has_motor_per_side =
      has_force_excess(model.quantities) && has_force_difference(*window.rows.log);
  vehicle.path.switches_off = values[at(ParameterId::kBackEmf)] > 0.0;
  set_plant(model, window, values, vehicle);
  vehicle.initial = window.measured;
  for (std::size_t i = 0; i < model.initial.size(); ++i) {
    channel_of(vehicle.initial, model.initial[i].channel) = initial_state[i];
  }
  vehicle.path.changes = window.changes;
  vehicle.path.first_change_column = model.quantities.size() + model.initial.size();
  vehicle.initial.steering_rad += vehicle.path.terms.value(Kind::kSteeringTrim);
  return vehicle;
}

LinearMotion first_motion(const LogModel& model, const SimulatedVehicle& vehicle,
                          std::size_t columns) {
  LinearMotion motion{vehicle.initial, std::vector<double>(kStateSize * columns, 0.0)};
  for (std::size_t i = 0; columns > 0 && i < model.initial.size(); ++i) {
    motion.row(model.initial[i].channel, columns)[model.quantities.size() + i] = 1.0;
  }
  if (const auto& trim = vehicle.path.terms[Kind::kSteeringTrim]; trim && columns > 0) {
    motion.row(LogChannel::kSteering, columns)[trim->column] = 1.0;
  }
  return motion;
}

}  // namespace awmr
