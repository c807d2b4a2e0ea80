/// Guidance along a line or polyline, by one of the guidance laws of line_laws.h. Freestanding
/// C++14.
#pragma once

#include "awmr/control/guidance/position.h"
#include "awmr/control/wrap_angle.h"

namespace awmr {

/// Below this speed, m/s, the direction of travel is noise: sideslip counts as 0.
template <class T>
constexpr T sideslip_speed_min_mps() {
  return T(0.05);
}

/// The sideslip angle, rad, in (-pi, pi]: the vehicle travels in the direction psi + beta.
///   beta = atan2(v, u)
/// 0 below sideslip_speed_min_mps().
template <class T>
AWMR_CALLED T sideslip_rad(const T& u_mps, const T& v_mps) {
  using math::atan2;
  const T least = sideslip_speed_min_mps<T>();
  if (!(u_mps * u_mps + v_mps * v_mps > least * least)) return T(0.0);
  return atan2(v_mps, u_mps);
}

/// Coordinates of a point relative to the segment from A to B. With its unit vector
/// t = (B - A)/|B - A|:
///   psi_AB = atan2(t_y, t_x)
///   e      = -(x - x_A) t_y + (y - y_A) t_x                         [paper (104)-(106), corrected]
/// Corrected: (105) prints the direction from B to A. (104) and (106) use the slope of the line,
/// which is infinite for a vertical line and the same for both directions of the line.
template <class T>
struct AlongSegment {
  T length_m;       ///< |B - A|, m
  T tx, ty;         ///< t; this and the following are undefined if length_m is 0
  T along_m;        ///< m: distance from A along t, negative before A
  T cross_track_m;  ///< e, m: left of the segment's line positive

  T psi_rad() const {
    using math::atan2;
    return atan2(ty, tx);
  }
};

/// Computes `position_m` relative to the segment from a to b.
template <class T>
AWMR_INLINE AlongSegment<T> along_segment(const Position<T>& a, const Position<T>& b,
                                          const Position<T>& position_m) {
  AlongSegment<T> s{};
  s.length_m = distance_m(a, b);
  if (!(s.length_m > T(0.0))) return s;
  s.tx = (b.x_m - a.x_m) / s.length_m;
  s.ty = (b.y_m - a.y_m) / s.length_m;
  const T dx = position_m.x_m - a.x_m;
  const T dy = position_m.y_m - a.y_m;
  s.along_m = dx * s.tx + dy * s.ty;
  s.cross_track_m = dy * s.tx - dx * s.ty;
  return s;
}

/// Motion of the vehicle that the guidance laws use.
template <class T>
struct LineMotion {
  T sideslip_rad;   ///< beta, rad
  T u_mps;          ///< u, m/s: surge speed
  T sample_time_s;  ///< time between two guidance steps, > 0
};

/// Range of a parameter of a guidance law in scenario files, in the unit of the file. The law
/// stores the file's value times `unit`, which is pi/180 for an angle in deg and otherwise 1.
struct LawParameter {
  double min;
  double max;
  bool min_excluded;
  double unit;
};

/// Range of lookahead distances in scenario files, m. With a shorter distance, the vehicle would
/// turn for every rounding error.
constexpr LawParameter lookahead_range() { return {1e-3, 1e6, false, 1.0}; }

/// Corners joined by line segments, driven from the first to the last. Two corners are one line.
///
/// A Law is a struct with its parameters and
///   sideslip_compensation     true, as in the paper: beta is subtracted, so that the course over
///                             ground is controlled and a vehicle that slips stays on the line;
///                             false: for vehicles that cannot measure v
///   kUsesCorner               whether the law uses Polyline::corner_m
///   name()                    its name in files
///   parameters(law, field)    calls field(key, parameter, LawParameter) for each parameter
/// and the function approach_rad(law, segment, motion, memory). guide() subtracts its result from
/// the segment's direction. A law can also have its own overloads of is_passed() and
/// distance_off_m() below.
template <class T, class Law>
struct Polyline {
  const Position<T>* points_m;  ///< the corners in the world frame, m; not owned, `count` of them
  int count;                    ///< >= 0; with fewer than two corners the line is finished at once
  /// m, >= 0: the vehicle changes to the next segment at this distance before the end of the
  /// current one, so that it rounds the corner on the inside. The last segment is driven to its
  /// end. With 0, the vehicle overshoots corners.
  T corner_m;
  Law law;  ///< parameters of the law
};

/// Progress along the corners.
template <class T>
struct PolylineProgress {
  int segment;  ///< the current segment: from points_m[segment] to points_m[segment + 1]
  T psi_rad;    ///< psi_d of the last step, rad, held when no segment is left
  T memory;     ///< state of the law, such as an integral; 0 at the start of each segment
};

/// The progress before the first step: `psi_rad` is the vehicle's heading.
template <class T>
PolylineProgress<T> start_polyline(const T& psi_rad) {
  return {0, psi_rad, T(0.0)};
}

/// Guidance output of one step.
template <class T>
struct PolylineGuidance {
  T psi_rad;        ///< psi_d, rad, in (-pi, pi]
  T cross_track_m;  ///< e, m: distance from the current segment's line, left positive
  T to_go_m;        ///< m: distance along the current segment to its end
  bool finished;    ///< past the end of the last segment: psi_d holds its last value
};

/// True if the vehicle must change to the next segment: the distance along the current segment to
/// its end is at most `corner_m`.
template <class T, class Law>
AWMR_INLINE bool is_passed(const Law&, const AlongSegment<T>& s, const T& corner_m) {
  return !(s.length_m - s.along_m > corner_m);
}

/// Distance from the line that PolylineGuidance reports, m, left positive. Default for laws without
/// their own overload: the distance from the current segment's line.
template <class T, class Law>
AWMR_INLINE T distance_off_m(const Polyline<T, Law>&, int /*segment*/,
                             const Position<T>& /*position_m*/, const AlongSegment<T>& s) {
  return s.cross_track_m;
}

/// The heading along the current segment, rad, in (-pi, pi]:
///   psi_d = psi_AB - beta - approach_rad()
/// Segments of zero length (coinciding corners) are skipped. Past the last segment, or if no
/// segment has a length, guidance is finished and the last psi_d is held.
template <class T, class Law>
AWMR_CALLED PolylineGuidance<T> guide(const Polyline<T, Law>& line, const Position<T>& position_m,
                                      const LineMotion<T>& motion, PolylineProgress<T>& progress) {
  T cross_track_m = T(0.0);
  for (; progress.segment + 1 < line.count; ++progress.segment, progress.memory = T(0.0)) {
    const AlongSegment<T> s = along_segment(line.points_m[progress.segment],
                                            line.points_m[progress.segment + 1], position_m);
    if (!(s.length_m > T(0.0))) continue;
    cross_track_m = distance_off_m(line, progress.segment, position_m, s);
    const T to_go_m = s.length_m - s.along_m;
    const bool is_last = progress.segment + 2 >= line.count;
    if (is_last ? !(to_go_m > T(0.0)) : is_passed(line.law, s, line.corner_m)) continue;
    const T beta = line.law.sideslip_compensation ? motion.sideslip_rad : T(0.0);
    progress.psi_rad = called_wrap_angle(
        T(s.psi_rad() - beta - approach_rad(line.law, s, motion, progress.memory)));
    return {progress.psi_rad, cross_track_m, to_go_m, false};
  }
  return {progress.psi_rad, cross_track_m, T(0.0), true};
}

}  // namespace awmr
