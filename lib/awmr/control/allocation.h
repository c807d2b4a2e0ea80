/// (tau_speed, tau_turn) -> (F'L, F'R, d_r), the exact inverse of [paper (41)]. Freestanding C++14.
///
/// No small-angle approximation: with q = tan(d_r/2), the quantity that the steering path sets,
///   sin d_r = 2 q/(1 + q^2),   1 + cos d_r = 2/(1 + q^2),   tau_steering = l_f tau_speed q,
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
  /// F'0 of every wheel: the forces here are those beyond it, and so are their limits; the command
  /// that goes out is with_dead_zone() of them.
  T dead_zone = T(0.0);
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

/// What the allocation needs of the limits, computed once; of Ts only. With h = q/2, a steering
/// angle costs one division and a pair of forces none.
template <class T>
struct AllocationConstants {
  T tau_speed_min;  ///< 4 F'min
  T tau_speed_max;  ///< 4 F'max
  T force_min;
  T force_max;
  T half_track_m;          ///< d
  T track_inverse;         ///< 1/(2 d)
  T half_track_inverse;    ///< 1/d
  T axle_twice_m;          ///< 2 l_f
  T axle_quarter_inverse;  ///< 1/(4 l_f)
  T axle_half_inverse;     ///< 1/(2 l_f)
  T steering_max_rad;      ///< d_max
  T h_max;                 ///< tan(d_max/2)/2
};

template <class T>
AllocationConstants<T> prepared(const AllocationLimits<T>& limits) {
  return {T(4.0) * limits.force_min,
          T(4.0) * limits.force_max,
          limits.force_min,
          limits.force_max,
          limits.half_track_m,
          T(0.5) / limits.half_track_m,
          T(1.0) / limits.half_track_m,
          T(2.0) * limits.front_axle_m,
          T(0.25) / limits.front_axle_m,
          T(0.5) / limits.front_axle_m,
          limits.steering_max_rad,
          T(0.5) * limits.steering_max_tan_half};
}

namespace detail {

/// x in [lo, hi]; `limited` is set where that changes it. NaN stays NaN.
template <class T>
T clipped(const T& x, const T& lo, const T& hi, bool& limited) {
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
/// The same, without a comparison of floats where |x| is below both limits and 0 between them.
AWMR_SHARED inline float clipped(float x, float lo, float hi, bool& limited) {
  const uint32_t magnitude = float_math::magnitude_bits(x);
  if (magnitude <= bits_of(hi) && magnitude <= bits_of(-lo) &&
      (bits_of(hi) | bits_of(-lo)) >> 31U == 0) {
    return x;
  }
  return clipped<float>(x, lo, hi, limited);
}

/// d_r = 2 atan q = 2 atan(2 h).
template <class T>
T angle_of_h(const T& h) {
  using math::atan;
  return T(2.0) * atan(T(2.0) * h);
}
inline float angle_of_h(float h) { return float_math::twice_atan_of_twice(h); }

/// h of the angle that makes a moment at tau_speed: h = q/2 = moment/(2 l_f tau_speed), clipped;
/// `half_ratio` is moment/(2 l_f).
template <class T>
T steering_for(const AllocationConstants<T>& c, const T& tau_speed, const T& half_ratio,
               Allocation<T>& a) {
  if (!(tau_speed > steering_authority_min<T>())) {
    a.steering_powerless = true;
    return T(0.0);
  }
  return clipped(half_ratio / tau_speed, -c.h_max, c.h_max, a.steering_limited);
}

/// d_max itself where h was clipped.
template <class T>
T angle_of(const AllocationConstants<T>& c, const T& h, const Allocation<T>& a) {
  if (a.steering_limited) return h > T(0.0) ? c.steering_max_rad : -c.steering_max_rad;
  return math::saturate(angle_of_h(h), c.steering_max_rad);
}

/// F'R,L = (tau_speed +- moment/d)/(2 (1 + cos d_r)) = (tau_speed +- moment/d)(1/4 + h^2), clipped.
template <class T>
void forces_for(const AllocationConstants<T>& c, const T& tau_speed, const T& moment_over_track,
                const T& quarter, Allocation<T>& a) {
  const T mean = tau_speed * quarter;
  const T half_difference = moment_over_track * quarter;
  a.force.left = clipped(mean - half_difference, c.force_min, c.force_max, a.force_limited);
  a.force.right = clipped(mean + half_difference, c.force_min, c.force_max, a.force_limited);
}

/// What the clipped forces leave of tau_turn goes to the steering. Returns h.
/// With 1 + cos d_r = 1/(2 (1/4 + h^2)):  tau_speed = (F'L + F'R)/(2 quarter),
/// delivered = d (F'R - F'L)/(2 quarter), so that
///   moment/(2 l_f tau_speed) = (2 quarter tau_turn - d (F'R - F'L))/(2 l_f (F'L + F'R))
template <class T>
T give_back(const AllocationConstants<T>& c, const T& tau_turn_m, const T& quarter,
            Allocation<T>& a) {
  const T rest_m =
      (quarter + quarter) * tau_turn_m - c.half_track_m * (a.force.right - a.force.left);
  return steering_for(c, a.force.left + a.force.right, rest_m * c.axle_half_inverse, a);
}

}  // namespace detail

/// tau_speed dimensionless, tau_turn_m in m; `split` is for the combined mode. Always finite for
/// finite input.
/// differential: d_r = 0;  F'R,L = tau_speed/4 +- tau_turn/(4 d)
/// steering:     d_r = 2 atan(tau_turn/(l_f tau_speed));  F'L = F'R = tau_speed/(2 (1 + cos d_r))
/// combined:     d_r = 2 atan(tau_turn/(2 l_f tau_speed)) and the other half of tau_turn by the
///               forces; with kRedistribute, what one path's limits take away goes to the other.
template <class T>
void allocate(YawMode mode, const T& tau_speed, const T& tau_turn_m,
              const AllocationConstants<T>& c, CombinedSplit split, Allocation<T>& a) {
  a = Allocation<T>{};
  const T speed = detail::clipped(tau_speed, c.tau_speed_min, c.tau_speed_max, a.speed_limited);
  const bool combined = mode == YawMode::kCombined;
  const bool redistribute = combined && split == CombinedSplit::kRedistribute;
  T h = T(0.0);
  T quarter = T(0.25);
  if (mode != YawMode::kDifferential) {
    // In the combined mode half of tau_turn: the half is in the constant.
    h = detail::steering_for(
        c, speed, tau_turn_m * (combined ? c.axle_quarter_inverse : c.axle_half_inverse), a);
    quarter = T(0.25) + h * h;
  }
  const bool lost = a.steering_limited || a.steering_powerless;
  T over_track = T(0.0);  // the forces' share of the moment over d
  if (redistribute && lost) {
    // Steering's moment: l_f tau_speed q = 2 h l_f tau_speed.
    over_track = (tau_turn_m - h * speed * c.axle_twice_m) * c.half_track_inverse;
  } else if (mode != YawMode::kSteering) {
    over_track = tau_turn_m * (combined ? c.track_inverse : c.half_track_inverse);
  }
  detail::forces_for(c, speed, over_track, quarter, a);
  if (redistribute && a.force_limited && !lost) {
    h = detail::give_back(c, tau_turn_m, quarter, a);
  }
  if (mode != YawMode::kDifferential) a.steering_rad = detail::angle_of(c, h, a);
}

template <class T>
Allocation<T> allocate(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                       const AllocationLimits<T>& limits) {
  Allocation<T> a{};
  allocate(mode, tau_speed, tau_turn_m, prepared(limits), limits.split, a);
  return a;
}

}  // namespace awmr
