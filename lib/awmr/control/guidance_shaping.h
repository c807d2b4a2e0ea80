/// Heading reference shaping: a filter that gives psi_d with its rate and acceleration.
/// Freestanding C++14.
#pragma once

#include "awmr/control/controller.h"

namespace awmr {

/// Second order, critically damped, its rate and acceleration limited:
///   e = wrap(psi_in - psi_d),  r_des = sat(w e/2, r_max),
///   psi_d_ddot = sat(2 w (r_des - psi_d_dot), a_max)
/// which without the limits is psi_ddot + 2 w psi_dot + w^2 psi = w^2 psi_in.
template <class T>
struct HeadingShaping {
  T omega_radps;       ///< w > 0; w T_s <= 0.5 keeps the discrete filter without overshoot
  T rate_max_radps;    ///< r_max > 0
  T accel_max_radps2;  ///< a_max > 0
};

template <class T>
struct ShapedHeading {
  T psi_rad;           ///< psi_d, unwrapped
  T psi_rate_radps;    ///< psi_d_dot
  T psi_accel_radps2;  ///< psi_d_ddot over the step that ends here
};

/// At rest on a heading.
template <class T>
ShapedHeading<T> start_shaping(const T& psi_rad) {
  return {psi_rad, T(0.0), T(0.0)};
}

/// One sample on (semi-implicit Euler: the new rate moves the heading). `target_rad` may jump and
/// may be wrapped: the filter takes the short way round.
template <class T>
void shape(const HeadingShaping<T>& filter, const T& target_rad, const T& sample_time_s,
           ShapedHeading<T>& state) {
  const T error = wrap_angle(target_rad - state.psi_rad);
  const T rate = math::saturate(filter.omega_radps * error / T(2.0), filter.rate_max_radps);
  state.psi_accel_radps2 = math::saturate(
      T(2.0) * filter.omega_radps * (rate - state.psi_rate_radps), filter.accel_max_radps2);
  state.psi_rate_radps += sample_time_s * state.psi_accel_radps2;
  state.psi_rad += sample_time_s * state.psi_rate_radps;
}

}  // namespace awmr
