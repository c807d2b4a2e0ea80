/// Coordinates of a resistance fit, and the corresponding model parameters. Private to identify/.
#pragma once

#include <array>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/model/family.h"

namespace awmr {

/// f = alpha w^beta + c + q w^2 at the force f + z. The coordinate of alpha is its logarithm,
/// because alpha is positive and its error is relative.
enum class TransformedParameter {
  kLogAlpha,   ///< ln alpha, without bounds
  kBeta,       ///< beta, 1, within the accepted range
  kCoulomb,    ///< c, >= 0
  kQuadratic,  ///< q, >= 0
  kDeadZone,   ///< z = 4 F'0, the dead zone of four wheels as tau_speed, >= 0
};
inline constexpr std::size_t kTransformedParameterCount = 5;
/// One number for each TransformedParameter, in its order.
using TransformedParameters = std::array<double, kTransformedParameterCount>;

/// Parameters that a family frees, in the order of TransformedParameter.
std::vector<TransformedParameter> coordinates_of(Family family);

/// The parameter's value: alpha from its logarithm, F'0 = z/4, the others unchanged.
double value_from(TransformedParameter c, double coordinate);
Interval values_from(TransformedParameter c, const Interval& coordinate);
/// The derivative of the value by the coordinate.
double jacobian_of(TransformedParameter c, double coordinate);

}  // namespace awmr
