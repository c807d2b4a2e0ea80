/// (tau_speed, tau_turn) -> (F'L, F'R, d_r), the exact inverse of [paper (41)]. Freestanding C++14.
///
/// No small-angle approximation: with q = tan(d_r/2), the quantity that the steering path sets,
///   sin d_r = 2 q/(1 + q^2),   1 + cos d_r = 2/(1 + q^2),
/// so that the only function needed is the arc tangent of the angle commanded. [paper (42),
/// corrected: L and R are swapped there against (41), and d stands where l_f belongs in d_r.]
///
/// Order of limits: tau_speed is clipped to [4 F'min, 4 F'max]; d_r to |d_r| <= d_max, and F'
/// follow from the clipped, commanded d_r; then each F' is clipped to [F'min, F'max].
#pragma once

#include "awmr/control/flash.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/model/scalar_math.h"
#include "awmr/model/state.h"

namespace awmr {

/// q = tan(angle/2), |angle| < pi.
template <class T>
T tan_half(const T& angle_rad) {
  using math::cos;
  using math::sin;
  return sin(angle_rad) / (T(1.0) + cos(angle_rad));
}

template <class T>
struct AllocationLimits {
  T front_axle_m;           ///< l_f, > 0
  T half_track_m;           ///< d, > 0
  T force_min;              ///< F'min of one wheel, over F_max
  T force_max;              ///< F'max of one wheel, > F'min
  T steering_max_rad;       ///< d_max, in (0, pi/2)
  T steering_max_tan_half;  ///< tan_half(d_max)
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

/// Below this tau_speed the front wheels push too little to turn the vehicle: d_r is commanded to
/// 0.
template <class T>
constexpr T steering_authority_min() {
  return T(1e-6);
}

namespace detail {

/// x in [lo, hi]; `limited` is set where that changes it.
template <class T>
AWMR_SHARED T clipped(const T& x, const T& lo, const T& hi, bool& limited) {
  if (x > hi) {
    limited = true;
    return hi;
  }
  if (x < lo) {
    limited = true;
    return lo;
  }
  return x;
}

/// q of the angle that makes `moment_m`: q = moment/(l_f tau_speed), clipped to tan(d_max/2).
template <class T>
AWMR_SHARED T steering_for(const AllocationLimits<T>& limits, const T& tau_speed, const T& moment_m,
                           Allocation<T>& a) {
  if (!(tau_speed > steering_authority_min<T>())) {
    a.steering_powerless = true;
    return T(0.0);
  }
  const T q = moment_m / (limits.front_axle_m * tau_speed);
  return clipped(q, -limits.steering_max_tan_half, limits.steering_max_tan_half,
                 a.steering_limited);
}

/// d_r = 2 atan q; d_max itself where q was clipped.
template <class T>
T angle_of(const AllocationLimits<T>& limits, const T& q, const Allocation<T>& a) {
  using math::atan;
  if (a.steering_limited) return q > T(0.0) ? limits.steering_max_rad : -limits.steering_max_rad;
  return math::saturate(T(2.0) * atan(q), limits.steering_max_rad);
}

/// F'R,L = (tau_speed +- moment/d)/(2 (1 + cos d_r)) = (tau_speed +- moment/d)(1 + q^2)/4, clipped.
template <class T>
SideForces<T> forces_for(const AllocationLimits<T>& limits, const T& tau_speed, const T& moment_m,
                         const T& q, Allocation<T>& a) {
  const T quarter = (T(1.0) + q * q) * T(0.25);
  const T mean = tau_speed * quarter;
  const T half_difference = moment_m / limits.half_track_m * quarter;
  return {clipped(mean - half_difference, limits.force_min, limits.force_max, a.force_limited),
          clipped(mean + half_difference, limits.force_min, limits.force_max, a.force_limited)};
}

/// q for the mode's steering share of tau_turn; `difference_m` is what it leaves to the forces:
/// with kRedistribute, what d_r's stop takes away too.
template <class T>
T share(YawMode mode, const AllocationLimits<T>& limits, const T& tau_speed, const T& tau_turn_m,
        T& difference_m, Allocation<T>& a) {
  difference_m = tau_turn_m;
  if (mode == YawMode::kDifferential) return T(0.0);
  const bool combined = mode == YawMode::kCombined;
  difference_m = combined ? tau_turn_m * T(0.5) : T(0.0);
  const T q = steering_for(limits, tau_speed, tau_turn_m - difference_m, a);
  const bool lost = a.steering_limited || a.steering_powerless;
  if (combined && lost && limits.split == CombinedSplit::kRedistribute) {
    // Steering's moment: l_f tau_speed sin d_r/(1 + cos d_r) = l_f tau_speed q.
    difference_m = tau_turn_m - limits.front_axle_m * tau_speed * q;
  }
  return q;
}

/// What the clipped forces leave of tau_turn goes to the steering. Returns q.
template <class T>
T give_back(const AllocationLimits<T>& limits, const T& tau_turn_m, const T& q, Allocation<T>& a) {
  // Both over 1 + cos d_r = 2/(1 + q^2).
  const T one_plus_cos = T(2.0) / (T(1.0) + q * q);
  const T delivered_m = limits.half_track_m * (a.force.right - a.force.left) * one_plus_cos;
  const T pair = (a.force.left + a.force.right) * one_plus_cos;
  return steering_for(limits, pair, tau_turn_m - delivered_m, a);
}

}  // namespace detail

/// tau_speed dimensionless, tau_turn_m in m. Always finite for finite input.
/// differential: d_r = 0;  F'R,L = tau_speed/4 +- tau_turn/(4 d)
/// steering:     d_r = 2 atan(tau_turn/(l_f tau_speed));  F'L = F'R = tau_speed/(2 (1 + cos d_r))
/// combined:     d_r = 2 atan(tau_turn/(2 l_f tau_speed)) and the other half of tau_turn by the
///               forces; with kRedistribute, what one path's limits take away goes to the other.
template <class T>
Allocation<T> allocate(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                       const AllocationLimits<T>& limits) {
  Allocation<T> a{};
  // By the quarter, which is a wheel's own: 4 F'min <= tau_speed <= 4 F'max.
  const T speed = T(4.0) * detail::clipped(tau_speed * T(0.25), limits.force_min, limits.force_max,
                                           a.speed_limited);
  T difference_m = T(0.0);
  T q = detail::share(mode, limits, speed, tau_turn_m, difference_m, a);
  a.force = detail::forces_for(limits, speed, difference_m, q, a);
  if (mode == YawMode::kCombined && limits.split == CombinedSplit::kRedistribute &&
      a.force_limited && !a.steering_limited && !a.steering_powerless) {
    q = detail::give_back(limits, tau_turn_m, q, a);
  }
  a.steering_rad = detail::angle_of(limits, q, a);
  return a;
}

}  // namespace awmr
