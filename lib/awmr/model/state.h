/// State and wheel forces of the vehicle, with named fields. Freestanding C++14.
///
/// World frame: x and y fixed to the ground. Body frame: origin at the centre of gravity, x forward
/// and y left. Both are right-handed with z up, so angles and yaw rates count counter-clockwise.
#pragma once

namespace awmr {

/// The state X = (x, y, psi, u, v, r) and the servo's angle. As a time derivative of the state,
/// each field is per second.
template <class T>
struct State {
  T x_m;           ///< x, m: position of the centre of gravity in the world frame
  T y_m;           ///< y, m: position of the centre of gravity in the world frame
  T psi_rad;       ///< psi, rad: heading, counter-clockwise from the world's x axis; not wrapped
  T u_mps;         ///< u, m/s: surge speed along the body's x axis, forward positive
  T v_mps;         ///< v, m/s: sway speed along the body's y axis, left positive
  T r_radps;       ///< r, rad/s: yaw rate, counter-clockwise positive
  T steering_rad;  ///< d_r, rad: actual angle of the front wheels, left positive; |d_r| <= d_max
};

/// The wheel forces if both wheels of a side have the same force. Each field is the force of ONE
/// wheel divided by F_max (the largest force of one motor), in [-1, 1], forward positive.
template <class T>
struct SideForces {
  T left;   ///< F'L = F'FL = F'RL
  T right;  ///< F'R = F'FR = F'RR
};

/// The individual forces of the wheels, divided by F_max, in [-1, 1]. They act along the wheel,
/// forward positive.
template <class T>
struct WheelForces {
  T front_left;   ///< F'FL
  T front_right;  ///< F'FR
  T rear_left;    ///< F'RL
  T rear_right;   ///< F'RR
};

}  // namespace awmr
