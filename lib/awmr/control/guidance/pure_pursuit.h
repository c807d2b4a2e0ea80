/// Pure pursuit, a guidance law that follows a line. Freestanding C++14.
///
/// The vehicle drives towards a goal point on the line, at the lookahead distance from the vehicle.
/// The goal passes a corner before the vehicle does, so the corner is rounded on its inside.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of pure pursuit.
template <class T>
struct PurePursuit {
  /// L, m, > 0: distance from the vehicle to its goal. Larger: smoother, slower to reach the line,
  /// and corners are cut more.
  T lookahead_m;
  bool sideslip_compensation;

  static constexpr bool kUsesCorner = false;
  static const char* name() { return "pure_pursuit"; }
  template <class Law, class Field>
  static void parameters(Law& law, Field field) {
    field("lookahead_m", law.lookahead_m, lookahead_range());
  }
};

/// Position of the goal along a segment, m from its start:
///   s_g = max(0, s + sqrt(L^2 - e^2))
/// s and e are the vehicle's distances along and to the left of the segment. The goal is the
/// farther of the two points of the line at the distance L from the vehicle. If the line is farther
/// away than L, the goal is the nearest point of the line. The goal is never before the segment's
/// start.
template <class T>
T goal_along_m(const PurePursuit<T>& law, const AlongSegment<T>& s) {
  using math::sqrt;
  const T ahead_m2 = law.lookahead_m * law.lookahead_m - s.cross_track_m * s.cross_track_m;
  const T goal_m = ahead_m2 > T(0.0) ? s.along_m + sqrt(ahead_m2) : s.along_m;
  return goal_m > T(0.0) ? goal_m : T(0.0);
}

/// The next segment starts when the goal reaches the end of the current one. On the last segment
/// the goal continues straight beyond its end.
template <class T>
bool is_passed(const PurePursuit<T>& law, const AlongSegment<T>& s, const T& /*corner_m*/) {
  return !(goal_along_m(law, s) < s.length_m);
}

/// Signed distance, left positive, from the line of the current or of the previous segment,
/// whichever is nearer. The previous segment is needed because the goal passes a corner before the
/// vehicle does.
template <class T>
T distance_off_m(const Polyline<T, PurePursuit<T>>& line, int segment,
                 const Position<T>& position_m, const AlongSegment<T>& s) {
  using math::abs;
  if (segment == 0) return s.cross_track_m;
  const AlongSegment<T> before =
      along_segment(line.points_m[segment - 1], line.points_m[segment], position_m);
  const bool is_nearer =
      before.length_m > T(0.0) && abs(before.cross_track_m) < abs(s.cross_track_m);
  return is_nearer ? before.cross_track_m : s.cross_track_m;
}

/// The approach angle atan2(e, s_g - s), rad, which guide() in line.h subtracts. psi_d then points
/// to the goal, which is s_g from A along the segment from A to B:
///   psi_d = psi_AB - beta - atan2(e, s_g - s)
/// (Coulter, Implementation of the pure pursuit path tracking algorithm, 1992. His law commands an
/// arc to the goal; here the heading law turns the vehicle to the heading of the goal.)
template <class T>
T approach_rad(const PurePursuit<T>& law, const AlongSegment<T>& s, const LineMotion<T>&,
               T& /*memory*/) {
  using math::atan2;
  return atan2(s.cross_track_m, T(goal_along_m(law, s) - s.along_m));
}

}  // namespace awmr
