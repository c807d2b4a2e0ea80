/// (tau_speed, tau_turn) -> (F'L, F'R, d_r), the exact inverse of [paper (41)]. Freestanding C++14.
///
/// No small-angle approximation: sin a/(1 + cos a) = tan(a/2). [paper (42), corrected: L and R are
/// swapped there against (41), and d stands where l_f belongs in d_r.]
///
/// Order of limits: tau_speed is clipped to [4 F'min, 4 F'max]; d_r to |d_r| <= d_max, and F' follow
/// from the clipped, commanded d_r; then each F' is clipped to [F'min, F'max].
#pragma once

#include "awmr/control/yaw_mode.h"
#include "awmr/model/scalar_math.h"
#include "awmr/model/state.h"

namespace awmr {

template <class T>
struct AllocationLimits {
  T front_axle_m;      ///< l_f, > 0
  T half_track_m;      ///< d, > 0
  T force_min;         ///< F'min of one wheel, over F_max
  T force_max;         ///< F'max of one wheel, > F'min
  T steering_max_rad;  ///< in (0, pi/2)
  CombinedSplit split = CombinedSplit::kRedistribute;
};

template <class T>
struct Allocation {
  SideForces<T> force;      ///< F' of each wheel of a side
  T steering_rad;           ///< the commanded d_r, left positive
  bool speed_limited;       ///< tau_speed was clipped
  bool steering_limited;    ///< d_r was clipped
  bool force_limited;       ///< an F' was clipped
  bool steering_powerless;  ///< steering was asked for, but tau_speed is too small to steer with
};

/// Below this tau_speed the front wheels push too little to turn the vehicle: d_r is commanded to 0.
template <class T>
constexpr T steering_authority_min() {
  return T(1e-6);
}

namespace detail {

/// Front wheels' angle that makes `moment_m`: d_r = 2 atan(moment/(l_f tau_speed)), clipped.
template <class T>
T steering_for(const AllocationLimits<T>& limits, const T& tau_speed, const T& moment_m,
               Allocation<T>& a) {
  using math::atan;
  if (!(tau_speed > steering_authority_min<T>())) {
    a.steering_powerless = true;
    return T(0.0);
  }
  const T angle = T(2.0) * atan(moment_m / (limits.front_axle_m * tau_speed));
  const T clipped = math::saturate(angle, limits.steering_max_rad);
  a.steering_limited = clipped < angle || clipped > angle;
  return clipped;
}

/// F'R,L = tau_speed/(2 (1 + cos d_r)) +- moment/(2 d (1 + cos d_r)), clipped.
template <class T>
SideForces<T> forces_for(const AllocationLimits<T>& limits, const T& tau_speed, const T& moment_m,
                         const T& steering_rad, Allocation<T>& a) {
  using math::cos;
  const T twice = T(2.0) * (T(1.0) + cos(steering_rad));
  const T mean = tau_speed / twice;
  const T half_difference = moment_m / (limits.half_track_m * twice);
  const T left = mean - half_difference;
  const T right = mean + half_difference;
  const SideForces<T> clipped{math::clamp(left, limits.force_min, limits.force_max),
                              math::clamp(right, limits.force_min, limits.force_max)};
  a.force_limited = clipped.left < left || clipped.left > left || clipped.right < right ||
                    clipped.right > right;
  return clipped;
}

}  // namespace detail

/// tau_speed dimensionless, tau_turn_m in m. Always finite for finite input.
/// differential: d_r = 0;  F'R,L = tau_speed/4 +- tau_turn/(4 d)
/// steering:     d_r = 2 atan(tau_turn/(l_f tau_speed));  F'L = F'R = tau_speed/(2 (1 + cos d_r))
/// combined:     half of tau_turn each way; with kRedistribute, what d_r's stop takes away is added to
///               the forces' share, and what the forces' limits take away then goes back to d_r.
template <class T>
Allocation<T> allocate(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                       const AllocationLimits<T>& limits) {
  using math::cos;
  using math::sin;
  Allocation<T> a{};
  const T speed =
      math::clamp(tau_speed, T(4.0) * limits.force_min, T(4.0) * limits.force_max);
  a.speed_limited = speed < tau_speed || speed > tau_speed;

  if (mode == YawMode::kDifferential) {
    a.steering_rad = T(0.0);
    a.force = detail::forces_for(limits, speed, tau_turn_m, a.steering_rad, a);
    return a;
  }
  if (mode == YawMode::kSteering) {
    a.steering_rad = detail::steering_for(limits, speed, tau_turn_m, a);
    a.force = detail::forces_for(limits, speed, T(0.0), a.steering_rad, a);
    return a;
  }

  const T half = tau_turn_m / T(2.0);
  const bool redistribute = limits.split == CombinedSplit::kRedistribute;
  a.steering_rad = detail::steering_for(limits, speed, half, a);
  // Steering's moment at d_r: l_f tau_speed tan(d_r/2) = l_f tau_speed sin d_r/(1 + cos d_r).
  const T steered = limits.front_axle_m * speed * sin(a.steering_rad) / (T(1.0) + cos(a.steering_rad));
  const T difference = redistribute ? tau_turn_m - steered : half;
  a.force = detail::forces_for(limits, speed, difference, a.steering_rad, a);
  if (redistribute && a.force_limited && !a.steering_limited && !a.steering_powerless) {
    const T delivered = limits.half_track_m * (a.force.right - a.force.left) *
                        (T(1.0) + cos(a.steering_rad));
    const T pair = (a.force.left + a.force.right) * (T(1.0) + cos(a.steering_rad));
    a.steering_rad = detail::steering_for(limits, pair, tau_turn_m - delivered, a);
  }
  return a;
}

}  // namespace awmr
