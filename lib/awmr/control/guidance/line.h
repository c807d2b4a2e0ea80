/// Guidance along a line or polyline, by one of the guidance laws of line_laws.h.
#pragma once

#include "awmr/control/guidance/position.h"
#include "awmr/control/wrap_angle.h"

namespace awmr {

/// Below this speed, m/s, the measured direction of travel is mostly noise, so sideslip is set to
/// 0.
template <class T>
constexpr T sideslip_speed_min_mps() {
  return T(0.05);
}

/// Sideslip angle beta, rad, in (-pi, pi]: the vehicle travels in the direction psi + beta.
///   beta = atan2(v, u)
/// u: surge speed, v: sway speed. The result is 0 below sideslip_speed_min_mps().
template <class T>
AWMR_CALLED T sideslip_rad(const T& u_mps, const T& v_mps) {
  using math::atan2;
  const T least = sideslip_speed_min_mps<T>();
  if (!(u_mps * u_mps + v_mps * v_mps > least * least)) return T(0.0);
  return atan2(v_mps, u_mps);
}

/// Coordinates of the point (x, y) relative to the segment from A to B, which has the direction
/// psi_AB and the unit vector t = (B - A)/|B - A|:
///   psi_AB = atan2(t_y, t_x)
///   e      = -(x - x_A) t_y + (y - y_A) t_x                         [paper (104)-(106), corrected]
/// e is the distance from the line through A and B, left positive. Corrected: (105) prints the
/// direction from B to A. (104) and (106) use the slope of the line, which is infinite for a
/// vertical line and the same for both directions of the line.
template <class T>
struct AlongSegment {
  T length_m;       ///< |B - A|, m
  T tx, ty;         ///< t; undefined, like the members below, if length_m is 0
  T along_m;        ///< m: distance from A in the direction t, negative before A
  T cross_track_m;  ///< e, m: distance from the line, left positive

  T psi_rad() const {
    using math::atan2;
    return atan2(ty, tx);
  }
};

/// Computes the coordinates of `position_m` relative to the segment from a to b.
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

/// Range of a parameter of a guidance law in scenario files, in the unit of the file. The program
/// uses the value times `unit`: pi/180 for an angle in deg, otherwise 1.
struct LawParameter {
  double min;
  double max;
  bool min_excluded;
  double unit;
};

/// Permitted lookahead distances in scenario files, m. Below the minimum, rounding errors of the
/// position would turn the vehicle.
constexpr LawParameter lookahead_range() { return {1e-3, 1e6, false, 1.0}; }

/// Points (corners) joined by straight segments, which are driven from the first to the last. Two
/// points give a single line.
///
/// A guidance law `Law` is a struct with its parameters and these members:
///   sideslip_compensation     true, as in the paper: the sideslip angle beta is subtracted from
///                             psi_d, so that a vehicle that slips sideways stays on the line;
///                             false: for vehicles that cannot measure the sway speed
///   kUsesCorner               whether the law uses Polyline::corner_m
///   name()                    its name in files
///   parameters(law, field)    calls field(key, parameter, LawParameter) for each parameter
/// It also has a function approach_rad(law, segment, motion, memory): the angle that guide()
/// subtracts from the direction of the segment. A law can have its own is_passed() and
/// distance_off_m(), below.
template <class T, class Law>
struct Polyline {
  const Position<T>* points_m;  ///< corners in the world frame, m; `count` of them, not owned
  int count;                    ///< >= 0; with 0 or 1 corners, the guidance is finished at once
  /// m, >= 0: at this distance before the end of a segment, the vehicle changes to the next
  /// segment, so that it rounds the corner on the inside. If this distance is 0, the vehicle
  /// overshoots the corner. The vehicle drives the last segment to its end.
  T corner_m;
  Law law;  ///< parameters of the law
};

/// Progress along the corners.
template <class T>
struct PolylineProgress {
  int segment;  ///< the current segment: from points_m[segment] to points_m[segment + 1]
  T psi_rad;    ///< last psi_d, rad; held once no segment is left
  /// State of the law, such as an integral. It is set to 0 at the start of each segment.
  T memory;
};

/// Returns the progress before the first step. `psi_rad` is the vehicle's heading.
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
  bool finished;    ///< the end of the last segment is passed, and psi_d is held
};

/// True if the vehicle must change to the next segment: the remaining distance along the current
/// segment is at most `corner_m`.
template <class T, class Law>
AWMR_INLINE bool is_passed(const Law&, const AlongSegment<T>& s, const T& corner_m) {
  return !(s.length_m - s.along_m > corner_m);
}

/// Distance from the line that PolylineGuidance reports, m, left positive: from the current
/// segment.
template <class T, class Law>
AWMR_INLINE T distance_off_m(const Polyline<T, Law>&, int /*segment*/,
                             const Position<T>& /*position_m*/, const AlongSegment<T>& s) {
  return s.cross_track_m;
}

/// Computes the desired heading for the current segment, rad, in (-pi, pi]:
///   psi_d = psi_AB - beta - approach_rad()
/// psi_AB: direction of the segment, beta: sideslip angle. Segments of zero length are skipped.
/// Past the last segment, or if all segments have zero length, guidance is finished and psi_d keeps
/// its last value.
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
