/// Pure pursuit, a guidance law that follows a line.
///
/// The vehicle drives towards a goal, a point on the line at the lookahead distance from the
/// vehicle. The goal passes a corner before the vehicle does, so the vehicle rounds the corner on
/// its inside.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of pure pursuit.
template <class T>
struct PurePursuit {
  /// L, m, > 0: lookahead distance from the vehicle to its goal. With a larger L, the motion is
  /// smoother, the line is reached later, and the vehicle cuts corners more.
  T lookahead_m;
  bool sideslip_compensation;

  static constexpr bool kUsesCorner = false;
  static const char* name() { return "pure_pursuit"; }
  template <class Law, class Field>
  static void parameters(Law& law, Field field) {
    field("lookahead_m", law.lookahead_m, lookahead_range());
  }
};

/// Position of the goal along a segment, m from the start of the segment:
///   s_g = max(0, s + sqrt(L^2 - e^2))
/// s: position of the vehicle along the segment; e: its distance to the left of the segment; L:
/// lookahead distance. Two points of the line are at the distance L from the vehicle; the goal is
/// the point farther along the line. If the line is farther away than L, the goal is the point of
/// the line nearest to the vehicle. The goal is never before the start of the segment.
template <class T>
T goal_along_m(const PurePursuit<T>& law, const AlongSegment<T>& s) {
  using math::sqrt;
  const T ahead_m2 = law.lookahead_m * law.lookahead_m - s.cross_track_m * s.cross_track_m;
  const T goal_m = ahead_m2 > T(0.0) ? s.along_m + sqrt(ahead_m2) : s.along_m;
  return goal_m > T(0.0) ? goal_m : T(0.0);
}

/// True when the goal reaches the end of the current segment: the next segment then starts. At the
/// last segment, the goal continues straight beyond the end.
template <class T>
bool is_passed(const PurePursuit<T>& law, const AlongSegment<T>& s, const T& /*corner_m*/) {
  return !(goal_along_m(law, s) < s.length_m);
}

/// Distance from the current or the previous segment, whichever is nearer, m, left positive.
/// Reason: at a corner, the goal is already on the current segment while the vehicle is still on
/// the previous one.
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

/// Returns the approach angle atan2(e, s_g - s), rad, which guide() in line.h subtracts from the
/// direction psi_AB of the segment:
///   psi_d = psi_AB - beta - atan2(e, s_g - s)
/// So psi_d is the direction from the vehicle to the goal. s and s_g: positions of the vehicle and
/// of the goal along the segment, m; e: distance of the vehicle from the segment, left positive;
/// beta: sideslip angle. (Coulter, Implementation of the pure pursuit path tracking algorithm,
/// 1992. His law commands an arc to the goal; here the heading law turns the vehicle to the
/// direction of the goal.)
template <class T>
T approach_rad(const PurePursuit<T>& law, const AlongSegment<T>& s, const LineMotion<T>&,
               T& /*memory*/) {
  using math::atan2;
  return atan2(s.cross_track_m, T(goal_along_m(law, s) - s.along_m));
}

}  // namespace awmr
