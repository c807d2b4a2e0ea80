/// Allocation: computes the left and right wheel forces F'L, F'R and the steering angle d_r from
/// the surge force tau_speed and the yaw moment tau_turn.
///
/// Limits, in this order: tau_speed is clipped to the motors' thrust, then d_r to |d_r| <= d_max.
/// The forces F' are computed with the clipped d_r and clipped to [F'min, F'max]. In combined mode
/// with CombinedSplit::kRedistribute, the wheel forces make the moment that the steering cannot
/// make at its stop, and the steering makes the moment that clipped wheel forces cannot make.
#pragma once

#include "awmr/control/allocation_limits.h"
#include "awmr/control/flash.h"
#include "awmr/control/motor_command.h"
#include "awmr/control/steering_geometry.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

namespace detail {

/// Steering that makes a yaw moment. q is a measure of the steering angle d_r: tan(d_r/2) with four
/// driven wheels (steering_geometry.h). `limited`: q was clipped. `powerless`: q is 0, because the
/// surge force tau_speed is too small to steer (below steering_authority_min()).
template <class T>
struct Steering {
  T q;
  Mask<T> limited;
  Mask<T> powerless;
};

/// Computes the steering q that makes the yaw moment `moment_m` with the surge force tau_speed:
///   q = moment/(l_f tau_speed), clipped to |q| <= limit
/// l_f is the distance from the centre of gravity to the front axle, m.
template <class T>
AWMR_INLINE Steering<T> steer(const AllocationConstants<T>& c, const T& tau_speed,
                              const T& moment_m, const T& limit) {
  using math::select;
  const Mask<T> powerless = math::is_above(steering_authority_min<T>(), tau_speed);
  const T q = select(powerless, T(0.0), T(math::flushed(moment_m) / (c.front_axle_m * tau_speed)));
  const T clipped = math::saturate(q, limit);
  return {clipped, math::is_different(clipped, q), powerless};
}

/// Converts q to the steering angle d_r, rad. If q was clipped (`at_stop`), the result is exactly
/// +-d_max.
template <class T>
AWMR_INLINE T steering_angle_rad(const SteeringGeometry& geometry, const AllocationConstants<T>& c,
                                 const T& q, const Mask<T>& at_stop) {
  using math::all;
  using math::select;
  const T stop_rad = math::with_sign(c.steering_max_rad, q);
  if (all(at_stop)) return stop_rad;
  return select(at_stop, stop_rad, math::saturate(geometry.to_angle_rad(q), c.steering_max_rad));
}

/// Computes the forces of a right and a left wheel and clips each to [F'min, F'max]:
///   F'R,L = (tau_speed +- moment/d) k
/// d: half the track width, m. k: force share, steering_geometry.h.
template <class T>
AWMR_INLINE void split_forces(const AllocationConstants<T>& c, const T& tau_speed,
                              const T& moment_m, const T& k, Allocation<T>& a) {
  const T difference = moment_m * c.half_track_inverse;
  const T left = (tau_speed - difference) * k;
  const T right = (tau_speed + difference) * k;
  a.force.left = math::clamp(left, c.force_min, c.force_max);
  a.force.right = math::clamp(right, c.force_min, c.force_max);
  a.force_limited =
      math::is_different(a.force.left, left) || math::is_different(a.force.right, right);
}

}  // namespace detail

/// Computes the commands that make the surge force tau_speed (dimensionless, forward positive) and
/// the yaw moment tau_turn (m, counter-clockwise positive):
///   l_f tau_speed q = s tau_turn
///   F'R,L           = (tau_speed +- (1 - s) tau_turn/d) k                 [paper (42), corrected]
/// s is the share of the yaw moment that steering makes: 0 in differential mode, 1 in steering
/// mode, 1/2 in combined mode. q and k depend on the steering angle d_r (steering_geometry.h): with
/// four driven wheels, q = tan(d_r/2) and k = (1 + q^2)/4. l_f: centre of gravity to front axle, m;
/// d: half the track width, m. generalised_forces() is the inverse function.
///
/// Corrected: the paper prints the combined mode with L and R swapped against its (41), and with d
/// instead of l_f in d_r. The paper's small-angle form, also available (steering_geometry.h), omits
/// 3 % of the thrust at 20 deg. The result is finite for finite input.
template <class T>
AWMR_INLINE void allocate(const SteeringGeometry& geometry, const YawSplit<T>& split,
                          const T& tau_speed, const T& tau_turn_m, const AllocationConstants<T>& c,
                          Allocation<T>& a) {
  using math::any;
  using math::select;
  const T speed = math::clamp(tau_speed, c.tau_speed_min, c.tau_speed_max);
  a.speed_limited = math::is_different(speed, tau_speed);

  // Steering makes the fraction s of the yaw moment, or less if it reaches its stop.
  const T steered_m = split.steering_share * tau_turn_m;
  const T limit = steering_limit(c, speed);
  detail::Steering<T> steering = detail::steer(c, speed, steered_m, limit);

  // The wheel forces make the moment that the steering leaves. With CombinedSplit::kRedistribute,
  // they also make the moment that the steering cannot make: it is at its stop, or tau_speed is too
  // small.
  const Mask<T> leaves = split.redistributes && (steering.limited || steering.powerless);
  T moment_m = tau_turn_m - steered_m;
  if (any(leaves))
    moment_m = select(leaves, T(tau_turn_m - c.front_axle_m * speed * steering.q), moment_m);
  const T k = geometry.to_force_share(steering.q);
  detail::split_forces(c, speed, moment_m, k, a);

  // If wheel forces were clipped, the steering makes the moment that is missing, up to its stop.
  // The clipped forces make the surge force tau_speed = (F'L + F'R)/(2 k) and the yaw moment
  // tau_diff = d (F'R - F'L)/(2 k). So the steering needs
  //   q = (tau_turn - tau_diff)/(l_f tau_speed)
  // The code multiplies numerator and denominator by 2 k, which avoids two divisions.
  const Mask<T> returns = split.redistributes && a.force_limited && !leaves;
  if (any(returns)) {
    const T rest_m = (k + k) * tau_turn_m - c.half_track_m * (a.force.right - a.force.left);
    const auto more = detail::steer(c, T(a.force.left + a.force.right), rest_m, limit);
    steering.q = select(returns, more.q, steering.q);
    steering.limited = steering.limited || (returns && more.limited);
    steering.powerless = steering.powerless || (returns && more.powerless);
  }
  a.steering_limited = steering.limited;
  a.steering_powerless = steering.powerless && math::is_above(split.steering_share, T(0.0));
  a.steering_rad = detail::steering_angle_rad(
      geometry, c, steering.q, a.steering_limited && !math::is_different(limit, c.q_max));
}

/// Allocates in the given yaw mode. The speed u = `u_mps`, forward positive, matters only for
/// motors with back-EMF, which lowers the force limits by k_e u.
template <class T>
Allocation<T> allocate(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                       const AllocationLimits<T>& limits, const T& u_mps = T(0.0)) {
  const SteeringGeometry geometry = geometry_of(limits);
  Allocation<T> a;
  allocate(geometry, yaw_split<T>(mode, limits.split), tau_speed, tau_turn_m,
           at_speed(prepared(limits), limits.back_emf_s_per_m, u_mps, geometry.driven_wheels()), a);
  return a;
}

}  // namespace awmr
