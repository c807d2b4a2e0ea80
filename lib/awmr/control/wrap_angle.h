/// Wraps an angle to the equivalent angle in (-pi, pi].
#pragma once

#include "awmr/core/units.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Number of full turns up to which wrap_angle() subtracts 2 pi repeatedly. For larger angles, it
/// uses atan2.
constexpr int kTurnsOneByOne = 64;

/// Returns the equivalent angle in (-pi, pi], in bounded computing time. NaN and infinity give NaN.
template <class T>
T wrap_angle(T angle_rad) {
  using math::atan2;
  using math::cos;
  using math::sin;
  const T few = T(2.0 * kTurnsOneByOne) * pi<T>();
  // A negated comparison is also true for NaN, so the second test returns NaN, for which the second
  // loop below would not end.
  if (!(angle_rad < few && angle_rad > -few)) angle_rad = atan2(sin(angle_rad), cos(angle_rad));
  if (!(angle_rad < few && angle_rad > -few)) return angle_rad;
  while (angle_rad > pi<T>()) angle_rad -= T(2.0) * pi<T>();
  while (!(angle_rad > -pi<T>())) angle_rad += T(2.0) * pi<T>();
  return angle_rad;
}
/// For float: takes the same time for every angle, as a control step on the chip requires.
template <>
inline float wrap_angle(float angle_rad) {
  return float_math::wrapped(angle_rad);
}

/// Same as wrap_angle(), but not inlined. For guidance, where the time of a call does not matter.
template <class T>
AWMR_CALLED T called_wrap_angle(const T& angle_rad) {
  return wrap_angle(angle_rad);
}

/// Prepares an angle that is integrated over many steps for the next step. A float is wrapped to
/// (-pi, pi], because its resolution becomes too coarse after many turns. Other types are returned
/// unchanged.
template <class T>
T without_turns(const T& angle_rad) {
  return angle_rad;
}
inline float without_turns(float angle_rad) { return called_wrap_angle(angle_rad); }

}  // namespace awmr
