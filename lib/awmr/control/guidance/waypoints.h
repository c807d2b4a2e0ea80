/// Guidance to waypoints by line of sight.
#pragma once

#include "awmr/control/flash.h"
#include "awmr/control/guidance/position.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Waypoints, in the order in which they are reached.
template <class T>
struct Waypoints {
  const Position<T>* points_m;  ///< not owned; `count` of them
  int count;                    ///< >= 0
  /// m, > 0: a waypoint is reached when the vehicle is within this distance
  T acceptance_m;
  /// Selects what happens if the vehicle passes a waypoint at a distance of more than
  /// `acceptance_m`. (It has passed the waypoint when it is beyond the line through the waypoint
  /// that is perpendicular to the leg.) true: the waypoint counts as missed, and the vehicle drives
  /// to the next one. Set this for a vehicle that cannot turn tightly enough to return. false, as
  /// in the paper: the vehicle turns back to the waypoint.
  bool skip_passed;
};

/// Progress along the waypoints.
template <class T>
struct WaypointProgress {
  int next;                 ///< index of the current waypoint; `count` when all are done
  int missed;               ///< number of missed waypoints, see Waypoints::skip_passed
  Position<T> leg_start_m;  ///< start of the current leg
  T psi_rad;                ///< last direction to a waypoint, rad; held once no waypoint is left
};

/// Returns the progress before the first step. Arguments: position and heading of the vehicle.
template <class T>
WaypointProgress<T> start_waypoints(const Position<T>& position_m, const T& psi_rad) {
  return {0, 0, position_m, psi_rad};
}

/// Guidance output of one step.
template <class T>
struct WaypointGuidance {
  T psi_rad;      ///< psi_d, rad, in (-pi, pi]
  bool finished;  ///< no waypoint is left, and psi_d holds its last value
};

/// True if the position is beyond the line through the end of the leg, perpendicular to the leg.
/// False for a leg of zero length.
template <class T>
bool is_past(const Position<T>& position_m, const Position<T>& leg_start_m,
             const Position<T>& leg_end_m) {
  const T along = (position_m.x_m - leg_end_m.x_m) * (leg_end_m.x_m - leg_start_m.x_m) +
                  (position_m.y_m - leg_end_m.y_m) * (leg_end_m.y_m - leg_start_m.y_m);
  return along > T(0.0);
}

/// Computes the heading psi_d from the vehicle at (x, y) to the first waypoint (x_d, y_d) that is
/// not reached yet:
///   psi_d = atan2(y_d - y, x_d - x)                                       [paper (103), corrected]
/// Corrected: the printed differences point from the waypoint to the vehicle.
///
/// If the vehicle is within the acceptance radius of several waypoints in sequence, it reaches them
/// in the same step. If there are no waypoints, guidance is finished at once and psi_d keeps its
/// value. `acceptance_m2` is the square of Waypoints::acceptance_m.
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
/// Same as guide() above, but computes acceptance_m2 in each step.
template <class T>
AWMR_CALLED WaypointGuidance<T> guide(const Waypoints<T>& waypoints, const Position<T>& position_m,
                                      WaypointProgress<T>& progress) {
  const T acceptance_m2 = waypoints.acceptance_m * waypoints.acceptance_m;
  return guide(waypoints, acceptance_m2, position_m, progress);
}

/// Fraction of the reference speed at which the vehicle arrives at the end of the route. If this
/// fraction were 0, the vehicle would never reach the end.
template <class T>
constexpr T arrival_share_min() {
  return T(0.1);
}

/// Fraction of the reference speed at the distance `to_go_m` before the end of the route:
///   to_go_m/slow_down_m, clamped to [arrival_share_min(), 1]
/// `slow_down_m`, > 0, is the distance at which the speed begins to fall.
template <class T>
T arrival_share(const T& slow_down_m, const T& to_go_m) {
  return math::clamp(T(to_go_m / slow_down_m), arrival_share_min<T>(), T(1.0));
}

}  // namespace awmr
