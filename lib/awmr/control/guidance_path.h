/// Following a path that is given in time. Freestanding C++14.
#pragma once

#include "awmr/control/controller.h"
#include "awmr/control/guidance.h"

namespace awmr {

/// A point of a timed path and its derivatives.
template <class T>
struct PathPoint {
  Position<T> position_m;
  T vx_mps, vy_mps;
  T ax_mps2, ay_mps2;
};

/// x_d = A_x cos(w_x t),  y_d = A_y sin(w_y t)                                 [paper (117)-(118)]
template <class T>
struct Lissajous {
  T amplitude_x_m, amplitude_y_m;
  T rate_x_radps, rate_y_radps;

  PathPoint<T> at(const T& t_s) const {
    using math::cos;
    using math::sin;
    const T cx = amplitude_x_m * cos(rate_x_radps * t_s);
    const T sx = amplitude_x_m * sin(rate_x_radps * t_s);
    const T cy = amplitude_y_m * cos(rate_y_radps * t_s);
    const T sy = amplitude_y_m * sin(rate_y_radps * t_s);
    return {{cx, sy},
            -rate_x_radps * sx,
            rate_y_radps * cy,
            -rate_x_radps * rate_x_radps * cx,
            -rate_y_radps * rate_y_radps * sy};
  }
};

template <class T>
struct PathGuidance {
  T psi_rad;         ///< psi_d, in (-pi, pi]
  T psi_rate_radps;  ///< its derivative along the path
  T speed_mps;       ///< u_d >= 0
};

/// Below this speed, m/s, a path has no direction (a cusp, a turning point): the heading is held.
template <class T>
constexpr T path_speed_min_mps() {
  return T(1e-4);
}

/// Open in position, as in the paper: psi_d = atan2(yd_dot, xd_dot),  u_d = |p_d_dot|  [paper
/// (116)]
///   psi_d_dot = (xd_dot yd_ddot - yd_dot xd_ddot)/|p_d_dot|^2
/// `held_rad` is the psi_d of the step before, for a path that stands still.
template <class T>
PathGuidance<T> open_path(const PathPoint<T>& path, const T& held_rad) {
  using math::atan2;
  using math::sqrt;
  const T speed2 = path.vx_mps * path.vx_mps + path.vy_mps * path.vy_mps;
  const T least = path_speed_min_mps<T>();
  if (!(speed2 > least * least)) return {held_rad, T(0.0), T(0.0)};
  return {atan2(path.vy_mps, path.vx_mps),
          (path.vx_mps * path.ay_mps2 - path.vy_mps * path.ax_mps2) / speed2, sqrt(speed2)};
}

/// Closed in position, with k > 0 in 1/s and e_p = p_d - p:
///   psi_d = atan2(w_y, w_x) - beta  with  w = p_d_dot + k e_p,
///   u_d = max(0, |p_d_dot| + k e_p . t),  t the direction of the path
/// so that on the path the speed is the path's own, and behind it the vehicle catches up.
template <class T>
PathGuidance<T> closed_path(const PathPoint<T>& path, const T& gain_per_s,
                            const Position<T>& position_m, const T& sideslip, const T& held_rad) {
  using math::atan2;
  const PathGuidance<T> open = open_path(path, held_rad);
  const T ex = path.position_m.x_m - position_m.x_m;
  const T ey = path.position_m.y_m - position_m.y_m;
  const T wx = path.vx_mps + gain_per_s * ex;
  const T wy = path.vy_mps + gain_per_s * ey;
  const T least = path_speed_min_mps<T>();
  if (!(wx * wx + wy * wy > least * least)) return {held_rad, T(0.0), T(0.0)};
  const T along_m =
      open.speed_mps > T(0.0) ? (ex * path.vx_mps + ey * path.vy_mps) / open.speed_mps : T(0.0);
  const T speed_mps = open.speed_mps + gain_per_s * along_m;
  return {wrap_angle(atan2(wy, wx) - sideslip), open.psi_rate_radps,
          speed_mps > T(0.0) ? speed_mps : T(0.0)};
}

}  // namespace awmr
