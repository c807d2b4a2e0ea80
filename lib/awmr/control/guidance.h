/// Waypoints by line of sight. Freestanding C++14: the same source for the simulator and the AVR.
///
/// Lines and polylines are in guidance_line.h, timed paths in guidance_path.h, obstacles in
/// guidance_obstacles.h, heading reference shaping in guidance_shaping.h.
#pragma once

#include "awmr/control/flash.h"
#include "awmr/core/units.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// A point of the world frame, in which psi counts counter-clockwise from the x axis.
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

/// Points closer to each other than this, m, have no direction between them.
template <class T>
constexpr T coincident_m() {
  return T(1e-20);
}

/// Vector from one point to another, along the world's axes.
template <class T>
Position<T> seen_from(const Position<T>& from, const Position<T>& point) {
  return {point.x_m - from.x_m, point.y_m - from.y_m};
}

/// True if a point at `away_m` is within `radius_m`, whose square is `radius_m2`. Outside the
/// square around the circle, no product is necessary.
template <class T>
AWMR_INLINE bool is_reached(const Position<T>& away_m, const T& radius_m, const T& radius_m2) {
  if (math::is_beyond(away_m.x_m, radius_m) || math::is_beyond(away_m.y_m, radius_m)) return false;
  return !math::is_above(T(away_m.x_m * away_m.x_m + away_m.y_m * away_m.y_m), radius_m2);
}

/// The direction to a point at `away_m`, in (-pi, pi]; `otherwise_rad` if it coincides.
template <class T>
AWMR_INLINE T direction_rad(const Position<T>& away_m, const T& otherwise_rad) {
  const T here = coincident_m<T>();
  if (!math::is_beyond(away_m.x_m, here) && !math::is_beyond(away_m.y_m, here)) {
    return otherwise_rad;
  }
  return math::bearing(away_m.y_m, away_m.x_m);
}

/// Waypoints, in order.
template <class T>
struct Waypoints {
  const Position<T>* points_m;  ///< not owned; `count` of them
  int count;                    ///< >= 0
  T acceptance_m;               ///< m, > 0: a point is reached within this distance of it
  /// Handling of a waypoint that the vehicle has passed without coming within `acceptance_m`, that
  /// is, beyond the perpendicular to the leg through the point. true: it is counted as missed and
  /// the next one follows, for a vehicle that cannot turn tightly enough to return. false, as in
  /// the paper: the vehicle turns back to it.
  bool skip_passed;
};

/// Progress along the waypoints.
template <class T>
struct WaypointProgress {
  int next;                 ///< index of the current waypoint; `count` when all are done
  int missed;               ///< waypoints passed by, see Waypoints::skip_passed
  Position<T> leg_start_m;  ///< start of the current leg
  T psi_rad;                ///< the last line of sight, held if there is none
};

/// The progress before the first step: `position_m` and `psi_rad` are the vehicle's.
template <class T>
WaypointProgress<T> start_waypoints(const Position<T>& position_m, const T& psi_rad) {
  return {0, 0, position_m, psi_rad};
}

/// Guidance output of one step.
template <class T>
struct WaypointGuidance {
  T psi_rad;      ///< psi_d, in (-pi, pi]
  bool finished;  ///< no waypoint is left: psi_d holds the last line of sight
};

/// True beyond the perpendicular to the leg through its end. Never true for a leg of zero length.
template <class T>
bool is_past(const Position<T>& position_m, const Position<T>& leg_start_m,
             const Position<T>& leg_end_m) {
  const T along = (position_m.x_m - leg_end_m.x_m) * (leg_end_m.x_m - leg_start_m.x_m) +
                  (position_m.y_m - leg_end_m.y_m) * (leg_end_m.y_m - leg_start_m.y_m);
  return along > T(0.0);
}

/// The line of sight to the first waypoint (x_d, y_d) that is not reached yet:
///   psi_d = atan2(y_d - y, x_d - x)                                       [paper (103), corrected]
/// Corrected: the printed differences point from the waypoint to the vehicle.
///
/// Waypoints that coincide, or are within each other's acceptance radius, are reached in the same
/// step. With no waypoints, guidance is finished at once and the heading is held. `acceptance_m2`
/// is the square of Waypoints::acceptance_m.
template <class T>
AWMR_INLINE WaypointGuidance<T> guide(const Waypoints<T>& waypoints, const T& acceptance_m2,
                                      const Position<T>& position_m,
                                      WaypointProgress<T>& progress) {
  while (progress.next < waypoints.count) {
    const Position<T>& target = waypoints.points_m[progress.next];
    const Position<T> away_m = seen_from(position_m, target);
    const bool reached = is_reached(away_m, waypoints.acceptance_m, acceptance_m2);
    const bool missed =
        !reached && waypoints.skip_passed && is_past(position_m, progress.leg_start_m, target);
    if (!reached && !missed) {
      progress.psi_rad = direction_rad(away_m, progress.psi_rad);
      return {progress.psi_rad, false};
    }
    if (missed) ++progress.missed;
    progress.leg_start_m = target;
    ++progress.next;
  }
  return {progress.psi_rad, true};
}
/// As above, computing acceptance_m2 in each step.
template <class T>
AWMR_CALLED WaypointGuidance<T> guide(const Waypoints<T>& waypoints, const Position<T>& position_m,
                                      WaypointProgress<T>& progress) {
  const T acceptance_m2 = waypoints.acceptance_m * waypoints.acceptance_m;
  return guide(waypoints, acceptance_m2, position_m, progress);
}

/// Fraction of the speed at the last waypoint, so that the vehicle reaches it.
template <class T>
constexpr T arrival_share_min() {
  return T(0.1);
}

/// Fraction of the speed at `to_go_m` before the last waypoint: it decreases linearly within
/// `slow_down_m` > 0, down to arrival_share_min().
template <class T>
T arrival_share(const T& slow_down_m, const T& to_go_m) {
  return math::clamp(T(to_go_m / slow_down_m), arrival_share_min<T>(), T(1.0));
}

}  // namespace awmr
