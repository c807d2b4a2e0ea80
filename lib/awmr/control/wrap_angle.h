/// Wraps an angle to the equivalent angle in (-pi, pi]. Freestanding C++14.
#pragma once

#include "awmr/core/units.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Up to this number of turns, wrap_angle() subtracts 2 pi repeatedly. Above it, it uses atan2.
constexpr int kTurnsOneByOne = 64;

/// The equivalent angle in (-pi, pi], in bounded time. NaN stays NaN, and an infinite angle becomes
/// NaN.
template <class T>
T wrap_angle(T angle_rad) {
  using math::atan2;
  using math::cos;
  using math::sin;
  const T few = T(2.0 * kTurnsOneByOne) * pi<T>();
  // NaN compares false with every bound: without this test, the second loop below would not end.
  if (!(angle_rad < few && angle_rad > -few)) angle_rad = atan2(sin(angle_rad), cos(angle_rad));
  if (!(angle_rad < few && angle_rad > -few)) return angle_rad;
  while (angle_rad > pi<T>()) angle_rad -= T(2.0) * pi<T>();
  while (!(angle_rad > -pi<T>())) angle_rad += T(2.0) * pi<T>();
  return angle_rad;
}
/// For float, computing time is the same for every angle, as a control step on the chip requires.
template <>
inline float wrap_angle(float angle_rad) {
  return float_math::wrapped(angle_rad);
}

/// wrap_angle() that is not inlined, for guidance, where the time of a call does not matter.
template <class T>
AWMR_CALLED T called_wrap_angle(const T& angle_rad) {
  return wrap_angle(angle_rad);
}

/// Prepares an angle that is integrated over many steps for the next step. A float is wrapped to
/// (-pi, pi], because full turns would use up its resolution. Other types are returned unchanged.
template <class T>
T without_turns(const T& angle_rad) {
  return angle_rad;
}
inline float without_turns(float angle_rad) { return called_wrap_angle(angle_rad); }

}  // namespace awmr
