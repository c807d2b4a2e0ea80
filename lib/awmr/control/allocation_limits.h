/// Actuator limits that the allocation respects, and the commands that it returns.
#pragma once

#include "awmr/control/flash.h"
#include "awmr/control/steering_geometry.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/model/allocation_form.h"
#include "awmr/model/scalar_math.h"
#include "awmr/model/state.h"

namespace awmr {

/// Geometry and actuator limits of the vehicle.
template <class T>
struct AllocationLimits {
  T front_axle_m;  ///< l_f, m, > 0: centre of gravity to front axle
  T half_track_m;  ///< d, m, > 0: centre line to the middle of a wheel
  /// F'min, smallest force of a wheel divided by F_max, in [-1, F'max). Below 0: motors can
  /// reverse.
  T force_min;
  T force_max;              ///< F'max, largest force of a wheel divided by F_max, in (0, 1]
  T steering_max_rad;       ///< d_max, rad, in (0, pi/2): stop of the front wheels, either side
  T steering_max_tan_half;  ///< tan(d_max/2), stored because the chip computes no tangent
  /// Reaction of the combined mode when the steering or a wheel force saturates.
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// Form of the equations: exact, or for small angles (kPaper). The chip supports only kExact.
  AllocationForm form = AllocationForm::kExact;
  /// Dead zone F'0 of every motor, divided by F_max, >= 0. The allocated forces and the limits
  /// above do not contain it; with_dead_zone() adds it to the motor command.
  T dead_zone = T(0.0);
  /// k_e, s/m, >= 0: back-EMF coefficient of every motor (motor_force() in model/dynamics.h). The
  /// force of a wheel that rolls at u m/s is within [F'min - k_e u, F'max - k_e u].
  T back_emf_s_per_m = T(0.0);
  /// True: all four wheels are driven; false: only the front wheels. The chip supports only true.
  bool is_rear_driven = true;
};

/// Constants of the allocation, computed once from the limits. All members are of type T, so there
/// is no padding and a check sum can cover the struct.
template <class T>
struct AllocationConstants {
  T tau_speed_min;       ///< n F'min of n driven wheels
  T tau_speed_max;       ///< n F'max of n driven wheels
  T force_min;           ///< F'min
  T force_max;           ///< F'max
  T front_axle_m;        ///< l_f, m
  T half_track_m;        ///< d, m
  T half_track_inverse;  ///< 1/d, 1/m
  T steering_max_rad;    ///< d_max, rad
  T q_max;               ///< the steering q (steering_geometry.h) at d_r = d_max
};

template <class T>
SteeringGeometry geometry_of(const AllocationLimits<T>& limits) {
  return {limits.is_rear_driven, limits.form};
}

/// Computes the constants from the limits. With four driven wheels and the exact form, as on the
/// chip, q_max is the stored value steering_max_tan_half, so that the chip computes no tangent.
template <class T>
AllocationConstants<T> prepared(const AllocationLimits<T>& l) {
  const SteeringGeometry geometry = geometry_of(l);
  const bool on_chip = geometry.is_rear_driven && geometry.form == AllocationForm::kExact;
  const T wheels = T(geometry.driven_wheels());
  return {wheels * l.force_min,
          wheels * l.force_max,
          l.force_min,
          l.force_max,
          l.front_axle_m,
          l.half_track_m,
          T(1.0) / l.half_track_m,
          l.steering_max_rad,
          on_chip ? l.steering_max_tan_half : geometry.to_q(l.steering_max_rad)};
}

/// Smallest surge force tau_speed (dimensionless) at which the allocation steers. If the surge
/// force is smaller, the front wheels push too little to turn the vehicle, and the allocation sets
/// the steering angle d_r to 0.
template <class T>
constexpr T steering_authority_min() {
  return T(1e-6);
}
/// Smallest surge force tau_speed (dimensionless) at which the allocation uses the full steering
/// angle d_max: 1/64 of the thrust of four motors. Below it, steering_limit() reduces the angle.
template <class T>
constexpr T steering_authority_full() {
  return T(0.0625);
}

/// Limit of |q| at the surge force tau_speed, where q measures the steering (steering_geometry.h):
///   q_max sat(tau_speed/steering_authority_full(), [0, 1])
/// Reason: as tau_speed falls to 0, the q that makes a given moment grows as 1/tau_speed, and at
/// tau_speed <= 0 it is 0. With a constant limit, the wheels would jump from their stop to straight
/// ahead as tau_speed passes 0. The reduced limit makes the steering moment smaller by at most
/// 1/256 of its value at full thrust.
template <class T>
AWMR_INLINE T steering_limit(const AllocationConstants<T>& c, const T& tau_speed) {
  using math::any;
  const T full = steering_authority_full<T>();
  if (!any(math::is_above(full, tau_speed))) return c.q_max;
  return c.q_max * math::clamp(T(tau_speed * (T(1.0) / full)), T(0.0), T(1.0));
}

/// The allocated commands, and flags that tell which limits changed them.
template <class T>
struct Allocation {
  SideForces<T> force;       ///< force F' of each left and of each right wheel, in [F'min, F'max]
  T steering_rad;            ///< the commanded d_r, rad, left positive, |d_r| <= d_max
  Mask<T> speed_limited;     ///< tau_speed was clipped
  Mask<T> steering_limited;  ///< d_r was clipped
  Mask<T> force_limited;     ///< an F' was clipped
  /// True: the mode uses steering, but tau_speed is below steering_authority_min(), so d_r is 0.
  Mask<T> steering_powerless;
};

}  // namespace awmr
