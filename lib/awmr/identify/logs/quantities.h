/// Free quantities of a log fit: parameters, delays, command errors, biases. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/transform.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"

namespace awmr {

struct LogFitOptions;

/// One free quantity. The search changes its coordinate, which is the value or its logarithm.
struct FreeQuantity {
  /// kDelay: of all commands; kSteeringDelay: of the steering alone, on top of that; kMotorLag: the
  /// time
  /// constant of the motors; kSensorLag: that of a filter which smooths a channel; kSteeringTrim:
  /// the
  /// steering angle at a command of 0; kForceImbalance: half the relative difference of right and
  /// left.
  /// The order is that of the columns of a fit.
  enum class Kind {
    kParameter,
    kDelay,
    kSteeringDelay,
    kMotorLag,
    kSteeringTrim,
    kForceImbalance,
    kBias,
    kSensorDelay,
    kSensorLag
  };
  Kind kind = Kind::kParameter;
  ParameterId id = ParameterId::kMassNorm;  ///< of kParameter
  LogChannel channel =
      LogChannel::kX;  ///< of kSensorDelay (kX: of the position), kSensorLag, kBias
  Scale scale = Scale::kLinear;
  /// A typical large change of the coordinate: 1 for a logarithm (a factor e) or an exponent.
  double large_change = 1.0;

  bool is(ParameterId parameter) const { return kind == Kind::kParameter && id == parameter; }
  /// True for a time that cannot be negative.
  bool may_be_zero() const {
    return kind == Kind::kSteeringDelay || kind == Kind::kMotorLag || kind == Kind::kSensorDelay ||
           kind == Kind::kSensorLag;
  }
  std::string name() const;
  double value(double coordinate) const;
  double jacobian(double coordinate) const;  ///< d value / d coordinate
};

/// A parameter with its scale.
FreeQuantity free_parameter(ParameterId id);

/// Latency of all commands, s; negative: their time stamps are late.
FreeQuantity input_delay();

/// Additional delay of the steering relative to the forces, s, e.g. a servo's frame or a slower
/// bus.
FreeQuantity steering_delay();

/// The time constant of the motors, s.
FreeQuantity motor_lag();

/// The steering angle at a command of 0, rad; positive: to the left.
FreeQuantity steering_trim();

/// e of motors that push with (1 - e) times the command on the left and (1 + e) times on the right.
FreeQuantity force_imbalance();

/// The time constant of a first-order filter that smooths a channel, s.
FreeQuantity sensor_lag_of(LogChannel channel);

/// Latency of a channel, s.
FreeQuantity sensor_delay_of(LogChannel channel);

/// A free delay, lag or error of commands or sensors, with its initial guess.
struct FreeTerm {
  FreeQuantity quantity;
  double begin;
};

bool has_kind(const std::vector<FreeQuantity>& quantities, FreeQuantity::Kind kind);

/// Free quantities of a fit, by kind: the parameters, the terms of the commands, the biases, those
/// of the sensors.
std::vector<FreeQuantity> free_quantities(const LogFitOptions& options);

/// By quantity: the coordinate of the initial guess; 0 for a bias.
std::vector<double> initial_coordinates(const LogFitOptions& options);

/// By quantity: bounds of the coordinate, given its initial guess.
std::vector<Interval> coordinate_bounds(const std::vector<FreeQuantity>& quantities,
                                        const std::vector<double>& initial, const Vehicle& vehicle);

/// All parameters: `held`, overlaid by the free ones at the first coordinates.
ParameterValues<double> parameters_at(ParameterValues<double> held,
                                      const std::vector<FreeQuantity>& quantities,
                                      const std::vector<double>& coordinates);

/// By quantity: the value at each coordinate.
std::vector<double> values_at(const std::vector<FreeQuantity>& quantities,
                              const std::vector<double>& coordinates);

}  // namespace awmr
