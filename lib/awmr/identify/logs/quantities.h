/// The free numbers of a fit of logs: parameters, the input delay, biases. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/model/transform.h"

namespace awmr {

/// One free number. The search moves its coordinate, which is the value or its logarithm.
struct FreeQuantity {
  /// kDelay: of all commands; kMotorLag: the time constant of the motors.
  enum class Kind { kParameter, kDelay, kMotorLag, kSensorDelay, kBias };
  Kind kind = Kind::kParameter;
  ParameterId id = ParameterId::kMassNorm;  ///< of kParameter
  LogChannel channel = LogChannel::kX;      ///< of kSensorDelay (kX: of the position) and kBias
  Scale scale = Scale::kLinear;
  /// A change of the coordinate that would be large: a factor e for a logarithm, 1 for an exponent.
  double large_change = 1.0;

  bool is(ParameterId parameter) const { return kind == Kind::kParameter && id == parameter; }
  bool may_be_zero() const { return kind == Kind::kMotorLag || kind == Kind::kSensorDelay; }
  std::string name() const;
  double value(double coordinate) const;
  double jacobian(double coordinate) const;  ///< d value / d coordinate
};

/// A parameter with its scale.
FreeQuantity free_parameter(ParameterId id);

/// The time by which all commands act late, s; negative: they were logged late.
FreeQuantity input_delay();

/// The time constant of the motors, s.
FreeQuantity motor_lag();

/// The time by which a channel is read late, s.
FreeQuantity sensor_delay_of(LogChannel channel);

/// What a fit is free to move, in this order: the parameters, the input delay, the biases, the
/// sensors' delays.
std::vector<FreeQuantity> free_quantities(const LogFitOptions& options);

/// By quantity: the coordinate at the initial guess; a bias begins at zero.
std::vector<double> initial_coordinates(const std::vector<FreeQuantity>& quantities,
                                        const LogFitOptions& options);

/// By quantity: where the search may move the coordinate from its initial guess.
std::vector<Interval> coordinate_bounds(const std::vector<FreeQuantity>& quantities,
                                        const std::vector<double>& initial, const Vehicle& vehicle);

/// By quantity: the value at each coordinate.
std::vector<double> values_at(const std::vector<FreeQuantity>& quantities,
                              const std::vector<double>& coordinates);

}  // namespace awmr
