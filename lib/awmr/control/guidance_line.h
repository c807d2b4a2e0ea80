/// Following a line or a polyline. Freestanding C++14.
#pragma once

#include "awmr/control/controller.h"
#include "awmr/control/guidance.h"

namespace awmr {

/// Below this speed, m/s, the direction of travel is noise: sideslip counts as 0.
template <class T>
constexpr T sideslip_speed_min_mps() {
  return T(0.05);
}

/// beta = atan2(v, u), rad: the course is psi + beta. 0 at rest.
template <class T>
T sideslip_rad(const T& u_mps, const T& v_mps) {
  using math::atan2;
  const T least = sideslip_speed_min_mps<T>();
  if (!(u_mps * u_mps + v_mps * v_mps > least * least)) return T(0.0);
  return atan2(v_mps, u_mps);
}

template <class T>
struct LineLaw {
  T delta_rad;  ///< Delta in (0, pi/2]: angle at which the line is approached from outside the lane
  T width_m;    ///< R > 0: half width of the lane in which the approach flattens
  bool sideslip_compensation;  ///< subtract beta, so that the course, not the heading, is led
};

/// psi_d = psi_AB - beta - Delta sat(e/R), in (-pi, pi]                              [paper (107)]
/// e is the signed distance from the line, positive to the left of its direction.
template <class T>
T line_heading_rad(const LineLaw<T>& law, const T& psi_line_rad, const T& cross_track_m,
                   const T& sideslip) {
  const T beta = law.sideslip_compensation ? sideslip : T(0.0);
  return wrap_angle(psi_line_rad - beta -
                    law.delta_rad * math::saturate(cross_track_m / law.width_m, T(1.0)));
}

/// Corners joined by lines; two of them are one line.
template <class T>
struct Polyline {
  const Position<T>* points_m;  ///< not owned; `count` of them
  int count;                    ///< >= 0
  /// >= 0: the next segment is taken up this far before the present one ends, so that a corner is
  /// rounded from the inside; the last ends at its end.
  T corner_m;
  LineLaw<T> law;
};

template <class T>
struct PolylineProgress {
  int segment;  ///< from points_m[segment] to points_m[segment + 1]
  T psi_rad;    ///< the last psi_d, held where there is none
};

template <class T>
PolylineProgress<T> start_polyline(const T& psi_rad) {
  return {0, psi_rad};
}

template <class T>
struct PolylineGuidance {
  T psi_rad;        ///< psi_d, in (-pi, pi]
  T cross_track_m;  ///< e, left of the present segment positive
  T to_go_m;        ///< along the present segment, to its end
  bool finished;    ///< past the last segment's end: psi_d holds its last value
};

/// With the unit vector t from A to B:
///   psi_AB = atan2(t_y, t_x),   e = -(x - x_A) t_y + (y - y_A) t_x
/// [paper (104)-(105), corrected: (105) reverses the direction; the slope form of (104) does not
/// exist for a vertical line and loses the sign of the direction.]
/// Segments without length (points that coincide) are passed over; where none has any: finished.
template <class T>
PolylineGuidance<T> guide(const Polyline<T>& line, const Position<T>& position_m, const T& sideslip,
                          PolylineProgress<T>& progress) {
  using math::atan2;
  T cross_track_m = T(0.0);
  for (; progress.segment + 1 < line.count; ++progress.segment) {
    const Position<T>& a = line.points_m[progress.segment];
    const Position<T>& b = line.points_m[progress.segment + 1];
    const T length_m = distance_m(a, b);
    if (!(length_m > T(0.0))) continue;
    const T tx = (b.x_m - a.x_m) / length_m;
    const T ty = (b.y_m - a.y_m) / length_m;
    const T dx = position_m.x_m - a.x_m;
    const T dy = position_m.y_m - a.y_m;
    cross_track_m = dy * tx - dx * ty;
    const T to_go_m = length_m - (dx * tx + dy * ty);
    const bool last = progress.segment + 2 >= line.count;
    if (!(to_go_m > (last ? T(0.0) : line.corner_m))) continue;
    progress.psi_rad = line_heading_rad(line.law, atan2(ty, tx), cross_track_m, sideslip);
    return {progress.psi_rad, cross_track_m, to_go_m, false};
  }
  return {progress.psi_rad, cross_track_m, T(0.0), true};
}

}  // namespace awmr
