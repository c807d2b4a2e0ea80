/// Coordinates of a table fit and their conversion to model parameters. Private to identify/.
#pragma once

#include <array>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/model/family.h"

namespace awmr {

/// Coordinates of the curve alpha w^beta + c + q w^2 = f - z, with the force f, the dead zone z and
/// the rate w. alpha is positive with a relative error, so its coordinate is ln alpha.
enum class TransformedParameter {
  kLogAlpha,   ///< ln alpha, unbounded
  kBeta,       ///< beta (no unit), within the accepted range
  kCoulomb,    ///< c, >= 0
  kQuadratic,  ///< q, >= 0
  kDeadZone,   ///< z = 4 F'0: part of tau_speed lost in the dead zones F'0 of four wheels, >= 0
};
inline constexpr std::size_t kTransformedParameterCount = 5;
/// One number for each TransformedParameter, in its order.
using TransformedParameters = std::array<double, kTransformedParameterCount>;

/// Coordinates that are free in a family, in the order of TransformedParameter.
std::vector<TransformedParameter> coordinates_of(Family family);

/// Value of the model parameter at a coordinate: alpha = exp(ln alpha), F'0 = z/4, others
/// unchanged.
double value_from(TransformedParameter c, double coordinate);
Interval values_from(TransformedParameter c, const Interval& coordinate);
/// d value_from(c, coordinate) / d coordinate.
double jacobian_of(TransformedParameter c, double coordinate);

}  // namespace awmr
