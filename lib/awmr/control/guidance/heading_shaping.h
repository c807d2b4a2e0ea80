/// Filter that smooths the heading reference and also gives its rate and acceleration.
#pragma once

#include "awmr/control/wrap_angle.h"

namespace awmr {

/// A critically damped second-order filter with limited rate and acceleration. Its input is the
/// heading psi_in, its output the heading psi_d:
///   e          = wrap(psi_in - psi_d)
///   r_des      = sat(w e/2, r_max)
///   psi_d_ddot = sat(2 w (r_des - psi_d_dot), a_max)
/// w is the bandwidth, r_max the largest rate, a_max the largest acceleration. Without the limits,
/// the filter is psi_d_ddot + 2 w psi_d_dot + w^2 psi_d = w^2 psi_in.
template <class T>
struct HeadingShaping {
  /// w, rad/s, > 0: bandwidth. With a larger w, psi_d follows psi_in faster. The discrete filter
  /// does not overshoot if w T_s <= 0.5, with the sample time T_s.
  T omega_radps;
  /// r_max, rad/s, > 0: for example the largest yaw rate of the turning trials.
  T rate_max_radps;
  /// a_max, rad/s^2, > 0: for example the vehicle's largest yaw acceleration.
  T accel_max_radps2;
};

/// Output and state of the filter.
template <class T>
struct ShapedHeading {
  T psi_rad;           ///< psi_d, rad; wrapped to (-pi, pi] if T is float
  T psi_rate_radps;    ///< psi_d_dot, rad/s
  T psi_accel_radps2;  ///< psi_d_ddot, rad/s^2, during the last step
};

/// The filter at rest on a heading.
template <class T>
ShapedHeading<T> start_shaping(const T& psi_rad) {
  return {psi_rad, T(0.0), T(0.0)};
}

/// Advances the filter by one sample towards psi_in = target_rad, by semi-implicit Euler: psi_d
/// changes by the new rate times the sample time. The target may jump and may be wrapped: the
/// filter turns the shorter way.
template <class T>
void shape(const HeadingShaping<T>& filter, const T& target_rad, const T& sample_time_s,
           ShapedHeading<T>& state) {
  const T error = called_wrap_angle(target_rad - state.psi_rad);
  const T rate = math::saturate(filter.omega_radps * error / T(2.0), filter.rate_max_radps);
  state.psi_accel_radps2 = math::saturate(
      T(2.0) * filter.omega_radps * (rate - state.psi_rate_radps), filter.accel_max_radps2);
  state.psi_rate_radps += sample_time_s * state.psi_accel_radps2;
  state.psi_rad = without_turns(T(state.psi_rad + sample_time_s * state.psi_rate_radps));
}

}  // namespace awmr
