#include "awmr/identify/logs/simulated_vehicle.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/model/sliding.h"

namespace awmr {
namespace {

/// Raises a servo time constant below h/2 to h/2, which Runge-Kutta steps of h seconds resolve, and
/// drops its derivative. Otherwise a search for a time constant near 0 would end where the
/// integration diverges.
void slow_servo(double h, std::vector<ParameterColumn>& parameters, Plant<double>& plant) {
  if (!(plant.steering_time_constant_s < 0.5 * h)) return;
  plant.steering_time_constant_s = 0.5 * h;
  std::erase_if(parameters, [](const ParameterColumn& column) {
    return column.id == ParameterId::kSteeringTimeConstant;
  });
}

/// The smoothing of a channel with the variance `variance_s2`.
Smoothing smoothing_at(const LogModel& model, const FreeQuantity& quantity, double variance_s2,
                       std::size_t column) {
  const double rows2_per_s2 = std::pow(model.row_spacing_s, -2);
  const double variance = variance_s2 * rows2_per_s2;
  return {quantity.is_mean ? moving_average(variance) : gaussian_kernel(variance), column,
          rows2_per_s2};
}

}  // namespace

SimulatedVehicle vehicle_at(const LogModel& model, const FitWindow& window,
                            const double* coordinates, const double* initial_state) {
  SimulatedVehicle vehicle{};
  ParameterValues<double> values = model.held;
  for (std::size_t i = 0; i < model.quantities.size(); ++i) {
    const FreeQuantity& quantity = model.quantities[i];
    const double number = quantity.value(coordinates[i]);
    switch (quantity.kind) {
      case FreeQuantity::Kind::kParameter:
        values[at(quantity.id)] = number;
        vehicle.parameters.push_back({quantity.id, i, quantity.jacobian(coordinates[i])});
        break;
      case FreeQuantity::Kind::kDelay:
        vehicle.path.delay = {number, i};
        break;
      case FreeQuantity::Kind::kSteeringDelay:
        vehicle.path.steering_delay = {number, i};
        break;
      case FreeQuantity::Kind::kMotorLag:
        vehicle.path.lag.emplace(*window.rows.log, window.rows.begin, window.rows.end, number);
        vehicle.path.lag_column = i;
        break;
      case FreeQuantity::Kind::kSteeringTrim:
        vehicle.path.steering_trim = {number, i};
        break;
      case FreeQuantity::Kind::kServoRate:
        vehicle.path.servo_rate = {number, i};
        break;
      case FreeQuantity::Kind::kForceImbalance:
        vehicle.path.imbalance = {number, i};
        break;
      case FreeQuantity::Kind::kForceExponent:
        vehicle.path.exponent = {number, i};
        break;
      case FreeQuantity::Kind::kForceSaturation:
        vehicle.path.saturation = {number, i};
        vehicle.path.full_command = quantity.full_command;
        break;
      case FreeQuantity::Kind::kSaturationSharpness:
        vehicle.path.sharpness = {number, i};
        break;
      case FreeQuantity::Kind::kExtraForce:
        vehicle.extra[quantity.force] = number;
        vehicle.extra.columns.push_back({quantity.force, i, quantity.jacobian(coordinates[i])});
        break;
      case FreeQuantity::Kind::kSensorLag:
        vehicle.sensors.lag[at(quantity.channel)] = {{number, i}, quantity.is_at_rows};
        break;
      case FreeQuantity::Kind::kSmoothing:
        vehicle.sensors.smoothing[at(quantity.channel)] = smoothing_at(model, quantity, number, i);
        break;
      case FreeQuantity::Kind::kSensorDelay:
        vehicle.sensors.delay[at(quantity.channel)] = {number, i};
        if (quantity.channel == LogChannel::kX) {
          vehicle.sensors.delay[at(LogChannel::kY)] = {number, i};
        }
        break;
      case FreeQuantity::Kind::kWheelSlip:
        vehicle.sensors.slips.push_back({quantity.channel, {number, i}, quantity.is_ratio});
        break;
      case FreeQuantity::Kind::kSwayOffset:
        vehicle.sensors.sway_offset = {number, i};
        break;
      case FreeQuantity::Kind::kSwayAngle:
        vehicle.sensors.sway_angle = {number, i};
        break;
      case FreeQuantity::Kind::kBias:
        vehicle.sensors.bias[at(quantity.channel)] = number;
        vehicle.sensors.bias_column[at(quantity.channel)] = i;
        break;
    }
  }
  const double given_lag_s = model.vehicle.motor_time_constant_s.value_or(0.0);
  if (!vehicle.path.lag && given_lag_s > 0.0) {
    vehicle.path.lag.emplace(*window.rows.log, window.rows.begin, window.rows.end, given_lag_s);
  }
  vehicle.path.switches_off = values[at(ParameterId::kBackEmf)] > 0.0;
  vehicle.plant = resolved_beside_friction(plant_of(model.vehicle, values), model.longest_step_s);
  if (vehicle.path.servo_rate)
    vehicle.plant.steering_max_rate_radps = vehicle.path.servo_rate->value;
  slow_servo(model.longest_step_s, vehicle.parameters, vehicle.plant);
  // A logged steering angle is used directly, without servo limit or lag.
  if (!window.rows.log->steering_command_rad) vehicle.plant.steering_max_rad = 10.0;
  vehicle.initial = window.measured;
  for (std::size_t i = 0; i < model.initial.size(); ++i) {
    channel_of(vehicle.initial, model.initial[i].channel) = initial_state[i];
  }
  if (vehicle.path.steering_trim) vehicle.initial.steering_rad += vehicle.path.steering_trim->value;
  return vehicle;
}

LinearMotion first_motion(const LogModel& model, const SimulatedVehicle& vehicle,
                          std::size_t columns) {
  LinearMotion motion{vehicle.initial, std::vector<double>(kStateSize * columns, 0.0)};
  for (std::size_t i = 0; columns > 0 && i < model.initial.size(); ++i) {
    motion.row(model.initial[i].channel, columns)[model.quantities.size() + i] = 1.0;
  }
  if (vehicle.path.steering_trim && columns > 0) {
    motion.row(LogChannel::kSteering, columns)[vehicle.path.steering_trim->column] = 1.0;
  }
  return motion;
}

}  // namespace awmr
