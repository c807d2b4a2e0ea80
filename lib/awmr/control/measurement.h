/// Inputs of the controller: measurements and references. Avoids names that Arduino defines as
/// macros.
#pragma once

namespace awmr {

/// A GPS speed below this, m/s, can be the noise of a receiver at rest.
constexpr float kStandstill_mps = 0.3F;

/// Measured motion of the vehicle at one sample.
template <class T>
struct Measurement {
  T psi_rad;  ///< psi, rad: heading, counter-clockwise from the world's x axis, not wrapped
  T u_mps;    ///< u, m/s: surge speed, forward positive
  T v_mps;    ///< v, m/s: sway speed, left positive; 0 if it is not measured
  T r_radps;  ///< r, rad/s: yaw rate, counter-clockwise positive
};

/// Reference of the laws at one sample.
template <class T>
struct Reference {
  T psi_rad;           ///< psi_d, rad: desired heading, not wrapped
  T psi_rate_radps;    ///< psi_d_dot, rad/s: rate of psi_d; 0 for a constant heading
  T psi_accel_radps2;  ///< psi_d_ddot, rad/s^2: acceleration of psi_d; 0 for a constant heading
  T speed_mps;         ///< u_d, m/s: desired speed, forward positive
  T accel_mps2;        ///< u_d_dot, m/s^2: rate of u_d; 0 for a constant speed
};

}  // namespace awmr
