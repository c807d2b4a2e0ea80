#include "awmr/identify/logs/quantities.h"

#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/index.h"
#include "awmr/model/plausibility.h"
#include "awmr/model/sensor_delay_name.h"

namespace awmr {
namespace {

Interval bounds_of(const FreeQuantity& quantity, double initial, const Vehicle& vehicle) {
  constexpr double kLongest_s = 1.0;
  if (quantity.kind == FreeQuantity::Kind::kDelay) return {-kLongest_s, kLongest_s};
  if (quantity.may_be_zero()) return {0.0, kLongest_s};
  if (quantity.kind == FreeQuantity::Kind::kBias) return {-1e6, 1e6};
  if (quantity.id == ParameterId::kSurgeBeta) {
    return {vehicle.surge_beta_range.lo, vehicle.surge_beta_range.hi};
  }
  if (quantity.id == ParameterId::kYawBeta) {
    return {vehicle.yaw_beta_range.lo, vehicle.yaw_beta_range.hi};
  }
  if (quantity.scale == Scale::kLinear) return {0.0, 1e6};
  // A servo is not slower than kSlowestServo_s. Servo and yaw (I'z/g3') are two lags in a row: without an
  // end, a search may exchange them.
  const double most = quantity.is(ParameterId::kSteeringTimeConstant)
                          ? to_coordinate(quantity.scale, kSlowestServo_s)
                          : initial + 10.0;
  return {initial - 10.0, std::max(initial, most)};
}

}  // namespace

std::string FreeQuantity::name() const {
  switch (kind) {
    case Kind::kParameter:
      return std::string(info(id).name);
    case Kind::kDelay:
      return std::string(kInputDelayName);
    case Kind::kSteeringDelay:
      return std::string(kSteeringDelayName);
    case Kind::kMotorLag:
      return std::string(kMotorLagName);
    case Kind::kSensorDelay:
      return fmt::format("{}{}", kSensorDelayPrefix, info(channel).name);
    case Kind::kSensorLag:
      return fmt::format("{}{}", kSensorLagPrefix, info(channel).name);
    case Kind::kBias:
      return fmt::format("{}{}", kBiasPrefix, info(channel).name);
  }
  return {};
}

double FreeQuantity::value(double coordinate) const { return from_coordinate(scale, coordinate); }

double FreeQuantity::jacobian(double coordinate) const {
  return awmr::jacobian(scale, value(coordinate));
}

FreeQuantity free_parameter(ParameterId id) {
  // A term is measured against the force that it is a part of.
  return {.id = id, .scale = scale_of(id), .large_change = info(id).term ? 0.2 : 1.0};
}

FreeQuantity input_delay() { return {.kind = FreeQuantity::Kind::kDelay, .large_change = 0.1}; }

FreeQuantity steering_delay() {
  return {.kind = FreeQuantity::Kind::kSteeringDelay, .large_change = 0.1};
}

FreeQuantity motor_lag() { return {.kind = FreeQuantity::Kind::kMotorLag, .large_change = 0.1}; }

FreeQuantity sensor_delay_of(LogChannel channel) {
  return {.kind = FreeQuantity::Kind::kSensorDelay, .channel = channel, .large_change = 0.1};
}

FreeQuantity sensor_lag_of(LogChannel channel) {
  return {.kind = FreeQuantity::Kind::kSensorLag, .channel = channel, .large_change = 0.1};
}

std::vector<FreeQuantity> free_quantities(const LogFitOptions& options) {
  std::vector<FreeQuantity> quantities;
  for (const ParameterId id : options.free) quantities.push_back(free_parameter(id));
  if (options.input_delay_s) quantities.push_back(input_delay());
  if (options.steering_delay_s) quantities.push_back(steering_delay());
  if (options.motor_lag_s) quantities.push_back(motor_lag());
  for (const LogChannel channel : options.biases) {
    quantities.push_back({.kind = FreeQuantity::Kind::kBias, .channel = channel});
  }
  for (const SensorDelay& latency : options.sensor_delays) {
    quantities.push_back(sensor_delay_of(latency.channel));
  }
  for (const SensorDelay& smooth : options.sensor_lags) {
    quantities.push_back(sensor_lag_of(smooth.channel));
  }
  return quantities;
}

std::vector<double> initial_coordinates(const std::vector<FreeQuantity>& quantities,
                                        const LogFitOptions& options) {
  std::vector<double> coordinates;
  for (const FreeQuantity& q : quantities) {
    switch (q.kind) {
      case FreeQuantity::Kind::kParameter:
        coordinates.push_back(to_coordinate(q.id, options.initial_guess[at(q.id)]));
        break;
      case FreeQuantity::Kind::kDelay:
        coordinates.push_back(*options.input_delay_s);
        break;
      case FreeQuantity::Kind::kSteeringDelay:
        coordinates.push_back(*options.steering_delay_s);
        break;
      case FreeQuantity::Kind::kMotorLag:
        coordinates.push_back(*options.motor_lag_s);
        break;
      case FreeQuantity::Kind::kBias:
        coordinates.push_back(0.0);
        break;
      case FreeQuantity::Kind::kSensorDelay:
      case FreeQuantity::Kind::kSensorLag:
        break;
    }
  }
  for (const SensorDelay& latency : options.sensor_delays) coordinates.push_back(latency.delay_s);
  for (const SensorDelay& smooth : options.sensor_lags) coordinates.push_back(smooth.delay_s);
  return coordinates;
}

std::vector<Interval> coordinate_bounds(const std::vector<FreeQuantity>& quantities,
                                        const std::vector<double>& initial,
                                        const Vehicle& vehicle) {
  std::vector<Interval> bounds;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    bounds.push_back(bounds_of(quantities[i], initial[i], vehicle));
  }
  return bounds;
}

ParameterValues<double> parameters_at(ParameterValues<double> held,
                                      const std::vector<FreeQuantity>& quantities,
                                      const std::vector<double>& coordinates) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const FreeQuantity& q = quantities[i];
    if (q.kind == FreeQuantity::Kind::kParameter) held[at(q.id)] = q.value(coordinates[i]);
  }
  return held;
}

std::vector<double> values_at(const std::vector<FreeQuantity>& quantities,
                              const std::vector<double>& coordinates) {
  std::vector<double> values;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    values.push_back(quantities[i].value(coordinates[i]));
  }
  return values;
}

}  // namespace awmr
