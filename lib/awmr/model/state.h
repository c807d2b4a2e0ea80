/// Named state of the vehicle: right-handed, x forward, y left, psi counter-clockwise. Freestanding C++14.
#pragma once

namespace awmr {

template <class T>
struct State {
  T x_m;
  T y_m;
  T psi_rad;       ///< heading, unwrapped, counter-clockwise from the x axis
  T u_mps;         ///< surge, forward positive
  T v_mps;         ///< sway, left positive
  T r_radps;       ///< yaw rate, counter-clockwise positive
  T steering_rad;  ///< d_r, the front wheels' angle as it is, left positive
};

/// One force per side, over F_max: the left and right pairs are driven alike.
template <class T>
struct SideForces {
  T left;
  T right;
};

/// One force per wheel, over F_max.
template <class T>
struct WheelForces {
  T front_left;
  T front_right;
  T rear_left;
  T rear_right;
};

}  // namespace awmr
