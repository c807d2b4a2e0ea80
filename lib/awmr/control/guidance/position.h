/// Points in the world frame, and distances and directions between points.
#pragma once

#include "awmr/control/flash.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// A point of the world frame. Headings psi are measured counter-clockwise from its x axis.
template <class T>
struct Position {
  T x_m;  ///< x, m
  T y_m;  ///< y, m
};

/// The square of the distance between two points, m^2.
template <class T>
T squared_distance_m2(const Position<T>& a, const Position<T>& b) {
  const T dx = b.x_m - a.x_m;
  const T dy = b.y_m - a.y_m;
  return dx * dx + dy * dy;
}

/// The distance between two points, m, >= 0.
template <class T>
AWMR_CALLED T distance_m(const Position<T>& a, const Position<T>& b) {
  using math::sqrt;
  return sqrt(squared_distance_m2(a, b));
}

/// Two points coincide, and have no direction between them, if their x and y each differ by at most
/// this, m.
template <class T>
constexpr T coincident_m() {
  return T(1e-20);
}

/// Vector from the point `from` to the point `point`, m, in the world frame.
template <class T>
Position<T> seen_from(const Position<T>& from, const Position<T>& point) {
  return {point.x_m - from.x_m, point.y_m - from.y_m};
}

/// True if the length of the vector `away_m` is at most `radius_m`, whose square is `radius_m2`.
/// The components are tested first: one of them alone usually exceeds the radius, which saves the
/// products.
template <class T>
AWMR_INLINE bool is_reached(const Position<T>& away_m, const T& radius_m, const T& radius_m2) {
  if (math::is_beyond(away_m.x_m, radius_m) || math::is_beyond(away_m.y_m, radius_m)) return false;
  return !math::is_above(T(away_m.x_m * away_m.x_m + away_m.y_m * away_m.y_m), radius_m2);
}

/// Direction of the vector `away_m`, rad, in (-pi, pi]. If neither component exceeds
/// coincident_m(), the vector has no direction, and the result is `otherwise_rad`.
template <class T>
AWMR_INLINE T direction_rad(const Position<T>& away_m, const T& otherwise_rad) {
  const T here = coincident_m<T>();
  if (!math::is_beyond(away_m.x_m, here) && !math::is_beyond(away_m.y_m, here)) {
    return otherwise_rad;
  }
  return math::bearing(away_m.y_m, away_m.x_m);
}

}  // namespace awmr
