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
  enum class Kind { kParameter, kDelay, kBias };
  Kind kind = Kind::kParameter;
  ParameterId id = ParameterId::kMassNorm;  ///< of kParameter
  LogChannel channel = LogChannel::kX;      ///< of kBias
  Scale scale = Scale::kLinear;
  /// A change of the coordinate that would be large: a factor e for a logarithm, 1 for an exponent.
  double large_change = 1.0;

  bool is(ParameterId parameter) const { return kind == Kind::kParameter && id == parameter; }
  std::string name() const;
  double value(double coordinate) const;
  double jacobian(double coordinate) const;  ///< d value / d coordinate
};

/// What a fit is free to move, in this order: the parameters, the delay, the biases.
std::vector<FreeQuantity> free_quantities(const LogFitOptions& options);

/// By quantity: the coordinate at the initial guess; a delay and a bias begin at zero.
std::vector<double> initial_coordinates(const std::vector<FreeQuantity>& quantities,
                                        const ParameterValues<double>& initial_guess);

/// By quantity: where the search may move the coordinate from its initial guess.
std::vector<Interval> coordinate_bounds(const std::vector<FreeQuantity>& quantities,
                                        const std::vector<double>& initial, const Vehicle& vehicle);

/// By quantity: the value at each coordinate.
std::vector<double> values_at(const std::vector<FreeQuantity>& quantities,
                              const std::vector<double>& coordinates);

}  // namespace awmr
