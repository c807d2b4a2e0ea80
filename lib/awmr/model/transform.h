/// Coordinates of the parameters, in which fits search and random plants are drawn. The coordinate
/// of a parameter is its value or the logarithm of its value; the error of the coordinate is
/// assumed to be normally distributed:
///   linear:       coordinate = value        d value / d coordinate = 1
///   logarithmic:  coordinate = ln value     d value / d coordinate = value
/// Positive quantities have the logarithmic coordinate. The linear coordinate is for exponents,
/// which have a fixed range, and for optional terms, which can be exactly zero, so that they have
/// no logarithm.
#pragma once

#include <cmath>

#include "awmr/model/parameters.h"

namespace awmr {

enum class Scale { kLinear, kLogarithmic };

/// Linear: the exponents b1 and b3, and the optional terms (ParameterInfo::term: Coulomb,
/// quadratic, dead zone, back-EMF). Logarithmic: all other parameters.
inline Scale scale_of(ParameterId id) {
  const bool exponent = id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
  return exponent || info(id).term ? Scale::kLinear : Scale::kLogarithmic;
}

/// The coordinate of a value, which must be positive for a logarithmic scale.
inline double to_coordinate(Scale scale, double value) {
  return scale == Scale::kLogarithmic ? std::log(value) : value;
}
/// The value at a coordinate. A template on the scalar, so that derivatives of ceres::Jet are
/// propagated.
template <class T>
T from_coordinate(Scale scale, const T& coordinate) {
  using std::exp;
  return scale == Scale::kLogarithmic ? T(exp(coordinate)) : coordinate;
}
/// d value / d coordinate, at a value.
inline double jacobian(Scale scale, double value) {
  return scale == Scale::kLogarithmic ? value : 1.0;
}

inline double to_coordinate(ParameterId id, double value) {
  return to_coordinate(scale_of(id), value);
}
inline double from_coordinate(ParameterId id, double coordinate) {
  return from_coordinate(scale_of(id), coordinate);
}
/// d value / d coordinate, at a value.
inline double jacobian(ParameterId id, double value) { return jacobian(scale_of(id), value); }

}  // namespace awmr
