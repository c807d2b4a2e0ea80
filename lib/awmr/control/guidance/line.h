/// Following a line or a polyline. Freestanding C++14.
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

/// Parameters of the approach to a line.
template <class T>
struct LineLaw {
  /// Delta, rad, in (0, pi/2]: angle of approach outside the lane. Larger: the line is reached on a
  /// shorter way and more abruptly.
  T delta_rad;
  /// R, m, > 0: half width of the lane in which the approach angle is proportional to the distance.
  /// Larger: smoother, and slower to reach the line.
  T width_m;
  /// true, as in the paper: beta is subtracted, so that the course over ground is controlled and a
  /// vehicle that slips stays on the line. false: for vehicles that cannot measure v.
  bool sideslip_compensation;
};

/// The heading that approaches a line of direction psi_AB and then follows it, rad, in (-pi, pi]:
///   psi_d = psi_AB - beta - Delta sat(e/R)                                           [paper (107)]
/// e = cross_track_m is the signed distance from the line, m, positive to the left of its
/// direction; beta = sideslip, rad.
template <class T>
T line_heading_rad(const LineLaw<T>& law, const T& psi_line_rad, const T& cross_track_m,
                   const T& sideslip) {
  const T beta = law.sideslip_compensation ? sideslip : T(0.0);
  return called_wrap_angle(psi_line_rad - beta -
                           law.delta_rad * math::saturate(cross_track_m / law.width_m, T(1.0)));
}

/// Corners joined by line segments, driven from the first to the last. Two corners are one line.
/// `Law` is the approach to a segment: this one, or that of ilos.h.
template <class T, class Law = LineLaw<T>>
struct Polyline {
  const Position<T>* points_m;  ///< the corners in the world frame, m; not owned, `count` of them
  int count;                    ///< >= 0; with fewer than two corners the line is finished at once
  /// m, >= 0: the next segment starts this distance before the end of the current one, so that a
  /// corner is rounded on its inside. The last segment is driven to its end. 0: corners are
  /// overshot.
  T corner_m;
  Law law;  ///< approach to each segment
};

/// Progress along the corners.
template <class T>
struct PolylineProgress {
  int segment;  ///< from points_m[segment] to points_m[segment + 1]
  T psi_rad;    ///< the last psi_d, held if there is none
};

/// The progress before the first step: `psi_rad` is the vehicle's heading.
template <class T>
PolylineProgress<T> start_polyline(const T& psi_rad) {
  return {0, psi_rad};
}

/// Guidance output of one step.
template <class T>
struct PolylineGuidance {
  T psi_rad;        ///< psi_d, rad, in (-pi, pi]
  T cross_track_m;  ///< e, m: distance from the current segment's line, left positive
  T to_go_m;        ///< m: distance along the current segment to its end
  bool finished;    ///< past the end of the last segment: psi_d holds its last value
};

/// Coordinates of a point relative to the segment from A to B. With its unit vector
/// t = (B - A)/|B - A|:
///   psi_AB = atan2(t_y, t_x)
///   e      = -(x - x_A) t_y + (y - y_A) t_x                         [paper (104)-(106), corrected]
/// Corrected: (105) prints the direction from B to A. (104) and (106) print distance and direction
/// by the line's slope, which a vertical line does not have and which is the same from B to A.
template <class T>
struct AlongSegment {
  T length_m;       ///< |B - A|, m
  T tx, ty;         ///< t; this and the following are undefined if length_m is 0
  T along_m;        ///< m: from A, along t
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

/// Guidance along the current segment; `heading_rad` computes the heading from the segment's
/// direction and the distance from it.
///
/// Segments of zero length (coinciding corners) are skipped. If no segment has a length, guidance
/// is finished and the heading is held.
template <class T, class Law, class Heading>
AWMR_INLINE PolylineGuidance<T> guide_by(const Polyline<T, Law>& line,
                                         const Position<T>& position_m, const Heading& heading_rad,
                                         PolylineProgress<T>& progress) {
  T cross_track_m = T(0.0);
  for (; progress.segment + 1 < line.count; ++progress.segment) {
    const AlongSegment<T> s = along_segment(line.points_m[progress.segment],
                                            line.points_m[progress.segment + 1], position_m);
    if (!(s.length_m > T(0.0))) continue;
    cross_track_m = s.cross_track_m;
    const T to_go_m = s.length_m - s.along_m;
    const bool last = progress.segment + 2 >= line.count;
    if (!(to_go_m > (last ? T(0.0) : line.corner_m))) continue;
    progress.psi_rad = heading_rad(s.psi_rad(), cross_track_m);
    return {progress.psi_rad, cross_track_m, to_go_m, false};
  }
  return {progress.psi_rad, cross_track_m, T(0.0), true};
}

/// guide_by() with the law of (107).
template <class T>
AWMR_CALLED PolylineGuidance<T> guide(const Polyline<T>& line, const Position<T>& position_m,
                                      const T& sideslip, PolylineProgress<T>& progress) {
  const auto heading_rad = [&](const T& psi_line_rad, const T& cross_track_m) {
    return line_heading_rad(line.law, psi_line_rad, cross_track_m, sideslip);
  };
  return guide_by(line, position_m, heading_rad, progress);
}

}  // namespace awmr
