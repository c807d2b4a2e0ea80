/// Unit conversions and angles. Freestanding C++14: the AVR compiles this file too.
#pragma once

namespace awmr {

/// pi, rounded to the scalar type.
template <class T>
constexpr T pi() {
  return T(3.14159265358979323846);
}

/// Converts an angle or an angular rate from degrees to radians.
template <class T>
constexpr T radians(T degrees) {
  return degrees * T(3.14159265358979323846 / 180.0);
}

/// Converts an angle or an angular rate from radians to degrees.
template <class T>
constexpr T degrees(T radians) {
  return radians * T(180.0 / 3.14159265358979323846);
}

}  // namespace awmr
