/// Pure-pursuit following of a line or polyline, a baseline for comparison with the law of
/// line.h. Freestanding C++14.
///
/// The vehicle drives to a goal on the line at the lookahead distance ahead of it. The goal passes
/// a corner before the vehicle does, so the corner is rounded on its inside.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of pure pursuit.
template <class T>
struct PurePursuit {
  /// L, m, > 0: distance from the vehicle to its goal. Larger: smoother, slower to reach the line,
  /// and corners are cut more.
  T lookahead_m;
  bool sideslip_compensation;  ///< as in LineLaw
};

/// Corners joined by line segments, as in Polyline.
template <class T>
struct PursuedLine {
  const Position<T>* points_m;  ///< the corners in the world frame, m; not owned, `count` of them
  int count;                    ///< >= 0; with fewer than two corners the line is finished at once
  PurePursuit<T> law;
};

/// Position of the goal along a segment, m from its start:
///   s_g = max(0, s + sqrt(L^2 - e^2))
/// This is the farther of the two points of its line at distance L from a vehicle at s with offset
/// e; the nearest point of the line if all are farther away; the start if the vehicle is before the
/// segment.
template <class T>
T goal_along_m(const PurePursuit<T>& law, const AlongSegment<T>& s) {
  using math::sqrt;
  const T ahead_m2 = law.lookahead_m * law.lookahead_m - s.cross_track_m * s.cross_track_m;
  const T goal_m = ahead_m2 > T(0.0) ? s.along_m + sqrt(ahead_m2) : s.along_m;
  return goal_m > T(0.0) ? goal_m : T(0.0);
}

/// Distance from the line of the current or the last segment, whichever is nearer, because the goal
/// passes a corner before the vehicle does.
template <class T>
T nearer_cross_track_m(const PursuedLine<T>& line, int segment, const Position<T>& position_m,
                       const T& cross_track_m) {
  using math::abs;
  if (segment == 0) return cross_track_m;
  const AlongSegment<T> before =
      along_segment(line.points_m[segment - 1], line.points_m[segment], position_m);
  const bool is_nearer = before.length_m > T(0.0) && abs(before.cross_track_m) < abs(cross_track_m);
  return is_nearer ? before.cross_track_m : cross_track_m;
}

/// The heading to the goal, which is s_g along the current segment from A to B (Coulter,
/// Implementation of the pure pursuit path tracking algorithm, 1992; the heading to the goal
/// replaces the arc, because a heading law follows):
///   psi_d = psi_AB - beta + atan2(-e, s_g - s)
/// with s and e as in along_segment(), beta as in line_heading_rad(). The next segment starts when
/// the goal reaches the end of the current one. On the last segment the goal continues straight
/// beyond its end, and the segment is driven to its end.
///
/// Segments of zero length are skipped as in guide() of line.h.
template <class T>
PolylineGuidance<T> guide(const PursuedLine<T>& line, const Position<T>& position_m,
                          const T& sideslip, PolylineProgress<T>& progress) {
  using math::atan2;
  const T beta = line.law.sideslip_compensation ? sideslip : T(0.0);
  T cross_track_m = T(0.0);
  for (; progress.segment + 1 < line.count; ++progress.segment) {
    const AlongSegment<T> s = along_segment(line.points_m[progress.segment],
                                            line.points_m[progress.segment + 1], position_m);
    if (!(s.length_m > T(0.0))) continue;
    cross_track_m = nearer_cross_track_m(line, progress.segment, position_m, s.cross_track_m);
    const T goal_m = goal_along_m(line.law, s);
    const bool last = progress.segment + 2 >= line.count;
    if (!((last ? s.along_m : goal_m) < s.length_m)) continue;
    progress.psi_rad = called_wrap_angle(
        T(s.psi_rad() - beta + atan2(T(-s.cross_track_m), T(goal_m - s.along_m))));
    return {progress.psi_rad, cross_track_m, s.length_m - s.along_m, false};
  }
  return {progress.psi_rad, cross_track_m, T(0.0), true};
}

}  // namespace awmr
