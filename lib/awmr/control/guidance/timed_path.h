/// Guidance along a timed path, with and without position feedback.
#pragma once

#include "awmr/control/guidance/position.h"
#include "awmr/control/wrap_angle.h"

namespace awmr {

/// Point of a timed path, and its first and second time derivatives.
template <class T>
struct PathPoint {
  Position<T> position_m;  ///< p_d = (x_d, y_d), m
  T vx_mps, vy_mps;        ///< p_d_dot, m/s
  T ax_mps2, ay_mps2;      ///< p_d_ddot, m/s^2
};

/// A Lissajous figure, which the desired point (x_d, y_d) traverses as a function of the time t:
///   x_d = A_x cos(w_x t)
///   y_d = A_y sin(w_y t)                                                       [paper (117)-(118)]
template <class T>
struct Lissajous {
  T amplitude_x_m, amplitude_y_m;  ///< A_x, A_y, m: 10 each in the paper
  T rate_x_radps, rate_y_radps;    ///< w_x, w_y, rad/s: 0.01 and 0.03 in the paper

  /// The point of the path at the time t_s, s, and its first and second time derivatives.
  AWMR_CALLED PathPoint<T> at(const T& t_s) const {
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

/// Guidance output of one step.
template <class T>
struct PathGuidance {
  T psi_rad;         ///< psi_d, rad, in (-pi, pi]
  T psi_rate_radps;  ///< psi_d_dot, rad/s, of the path
  T speed_mps;       ///< u_d, m/s, >= 0
};

/// Smallest speed of the path's point, m/s, at which the path has a direction. At a lower speed, as
/// at a cusp or a reversal, the vehicle keeps its desired heading.
template <class T>
constexpr T path_speed_min_mps() {
  return T(1e-4);
}

/// Heading and speed along the path p_d = (x_d, y_d), without position feedback, as in the paper:
///   psi_d     = atan2(y_d_dot, x_d_dot)                                              [paper (116)]
///   psi_d_dot = (x_d_dot y_d_ddot - y_d_dot x_d_ddot)/|p_d_dot|^2
///   u_d       = |p_d_dot|
/// While |p_d_dot| <= path_speed_min_mps(), psi_d is `held_rad`, the psi_d of the last step, and
/// u_d is 0.
template <class T>
AWMR_CALLED PathGuidance<T> open_path(const PathPoint<T>& path, const T& held_rad) {
  using math::atan2;
  using math::sqrt;
  const T speed2 = path.vx_mps * path.vx_mps + path.vy_mps * path.vy_mps;
  const T least = path_speed_min_mps<T>();
  if (!(speed2 > least * least)) return {held_rad, T(0.0), T(0.0)};
  return {atan2(path.vy_mps, path.vx_mps),
          (path.vx_mps * path.ay_mps2 - path.vy_mps * path.ax_mps2) / speed2, sqrt(speed2)};
}

/// Heading and speed along the path with position feedback, an addition to the paper. p_d is the
/// point of the path, p the position of the vehicle, e_p = p_d - p the position error, t the unit
/// vector along the path, k = gain_per_s > 0 the gain, and beta = `sideslip` the sideslip angle,
/// rad:
///   w     = p_d_dot + k e_p
///   psi_d = atan2(w_y, w_x) - beta
///   u_d   = max(0, |p_d_dot| + k e_p . t)
/// A vehicle at p_d gets the speed of the path. A vehicle behind p_d gets a higher speed and
/// catches up. While |w| <= path_speed_min_mps(), psi_d is `held_rad`, the psi_d of the last step,
/// and u_d is 0.
template <class T>
AWMR_CALLED PathGuidance<T> closed_path(const PathPoint<T>& path, const T& gain_per_s,
                                        const Position<T>& position_m, const T& sideslip,
                                        const T& held_rad) {
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
  return {called_wrap_angle(atan2(wy, wx) - sideslip), open.psi_rate_radps,
          speed_mps > T(0.0) ? speed_mps : T(0.0)};
}

}  // namespace awmr
