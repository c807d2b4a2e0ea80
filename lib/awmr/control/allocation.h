/// Allocation: (tau_speed, tau_turn) -> (F'L, F'R, d_r), in three modes. Freestanding C++14.
///
/// The exact inverse of generalised_forces() in model/dynamics.h; the paper's small-angle form is
/// also available (AllocationForm). The exact steering path sets q = tan(d_r/2), with which
///   sin d_r      = 2 q/(1 + q^2)
///   1 + cos d_r  = 2/(1 + q^2)
///   tau_steering = l_f tau_speed q
/// so that only the arc tangent of the commanded angle is necessary. The code uses h = q/2 =
/// tan(d_r/2)/2, because then 1/(2 (1 + cos d_r)) = 1/4 + h^2: a steering angle needs one division,
/// a pair of forces none.
///
/// For small angles, 4 h is the angle and h^2 is negligible next to 1/4: AllocationForm::kPaper is
/// the same computation with d_r = 4 h and h^2 = 0.
///
/// Order of limits:
///   1. tau_speed is clipped to [4 F'min, 4 F'max];
///   2. d_r is clipped to |d_r| <= d_max, and the F' follow from the clipped, commanded d_r;
///   3. each F' is clipped to [F'min, F'max].
/// If tau_speed is small, d_r has a limit below d_max: steering_limit().
#pragma once

#include "awmr/control/flash.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/model/allocation_form.h"
#include "awmr/model/resistance.h"
#include "awmr/model/scalar_math.h"
#include "awmr/model/state.h"

namespace awmr {

/// q = tan(angle/2) = sin(angle)/(1 + cos(angle)), |angle| < pi.
template <class T>
T tan_half(const T& angle_rad) {
  using math::cos;
  using math::sin;
  return sin(angle_rad) / (T(1.0) + cos(angle_rad));
}

/// Geometry and actuator limits of the vehicle.
template <class T>
struct AllocationLimits {
  T front_axle_m;           ///< l_f, m, > 0: centre of gravity to front axle
  T half_track_m;           ///< d, m, > 0: centre line to the middle of a wheel
  T force_min;              ///< F'min of one wheel, over F_max, in [-1, F'max); < 0 reverses
  T force_max;              ///< F'max of one wheel, over F_max, in (0, 1]
  T steering_max_rad;       ///< d_max, rad, in (0, pi/2): stop of the front wheels, either side
  T steering_max_tan_half;  ///< tan_half(d_max): precomputed for the chip
  /// Action of the combined mode when one path saturates.
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// The chip supports only kExact.
  AllocationForm form = AllocationForm::kExact;
  /// F'0 of every wheel, over F_max, >= 0. The allocated forces and the limits above exclude it;
  /// the motor command is with_dead_zone() of them.
  T dead_zone = T(0.0);
  /// k_e of every motor, s/m, >= 0 (motor_force() in model/dynamics.h): a wheel that rolls at u m/s
  /// can make forces in [F'min - k_e u, F'max - k_e u].
  T back_emf_s_per_m = T(0.0);
  /// False: only the front wheels are driven. The chip supports only four driven wheels.
  bool is_rear_driven = true;
};

/// The commands, and the limits that are active.
template <class T>
struct Allocation {
  SideForces<T> force;       ///< F' of each wheel of a side, in [F'min, F'max]
  T steering_rad;            ///< the commanded d_r, rad, left positive, |d_r| <= d_max
  Mask<T> speed_limited;     ///< tau_speed was clipped
  Mask<T> steering_limited;  ///< d_r was clipped
  Mask<T> force_limited;     ///< an F' was clipped
  /// Steering was requested, but tau_speed is too small to steer with.
  Mask<T> steering_powerless;
};

/// Below this tau_speed, the front wheels push too little to turn the vehicle, and the commanded
/// d_r is 0.
template <class T>
constexpr T steering_authority_min() {
  return T(1e-6);
}
/// From this tau_speed on (1/64 of the thrust of four motors), d_r can reach its stop.
template <class T>
constexpr T steering_authority_full() {
  return T(0.0625);
}

/// Constants of the allocation, computed once from the limits. All members are of type T, so there
/// is no padding and a check sum can cover it.
template <class T>
struct AllocationConstants {
  T tau_speed_min;         ///< 4 F'min
  T tau_speed_max;         ///< 4 F'max
  T force_min;             ///< F'min
  T force_max;             ///< F'max
  T half_track_m;          ///< d, m
  T track_inverse;         ///< 1/(2 d), 1/m
  T half_track_inverse;    ///< 1/d, 1/m
  T axle_twice_m;          ///< 2 l_f, m
  T axle_quarter_inverse;  ///< 1/(4 l_f), 1/m
  T axle_half_inverse;     ///< 1/(2 l_f), 1/m
  T steering_max_rad;      ///< d_max, rad
  T h_max;                 ///< tan(d_max/2)/2
};

/// Computes the constants from the limits, for the exact form.
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

/// Constants at the speed u, m/s, for motors with back-EMF: the force limits are reduced by k_e u.
/// motor_commands() handles the turn's part of a wheel's speed, +- d r.
template <class T>
AllocationConstants<T> at_speed(AllocationConstants<T> c, const T& back_emf_s_per_m,
                                const T& u_mps) {
  const T lost = back_emf_s_per_m * u_mps;
  c.tau_speed_min = c.tau_speed_min - T(4.0) * lost;
  c.tau_speed_max = c.tau_speed_max - T(4.0) * lost;
  c.force_min = c.force_min - lost;
  c.force_max = c.force_max - lost;
  return c;
}

/// Motor drives e that make these forces at the speed u, m/s, and yaw rate r, rad/s:
///   e = sat(F' + k_e w, [F'min, F'max]),   w = u -+ d r           upper sign: left, lower: right
/// w is the speed of a rear wheel; a front wheel's differs by d_r^2/2 of it and by l_f r d_r.
/// A drive of 0 switches the motor off: a vehicle that cannot reverse its motors (F'min = 0) brakes
/// by back-EMF while its drive is above 0, and rolls freely otherwise. NaN stays NaN.
template <class T>
SideForces<T> motor_drives(const SideForces<T>& force, const AllocationConstants<T>& c,
                           const T& back_emf_s_per_m, const T& u_mps, const T& r_radps) {
  using math::any;
  if (!any(back_emf_s_per_m > T(0.0))) return force;
  const T turn_mps = c.half_track_m * r_radps;
  return {
      math::clamp(T(force.left + back_emf_s_per_m * (u_mps - turn_mps)), c.force_min, c.force_max),
      math::clamp(T(force.right + back_emf_s_per_m * (u_mps + turn_mps)), c.force_min,
                  c.force_max)};
}

/// Motor commands that make these drives with a dead zone.
template <class T>
SideForces<T> with_dead_zone(const SideForces<T>& drive, const T& dead_zone) {
  return {with_dead_zone(drive.left, dead_zone), with_dead_zone(drive.right, dead_zone)};
}

/// Motor commands that make these forces, with dead zone and back-EMF.
template <class T>
SideForces<T> motor_commands(const SideForces<T>& force, const AllocationConstants<T>& c,
                             const T& dead_zone, const T& back_emf_s_per_m, const T& u_mps,
                             const T& r_radps) {
  return with_dead_zone(motor_drives(force, c, back_emf_s_per_m, u_mps, r_radps), dead_zone);
}

namespace detail {

/// x limited to [lo, hi]; sets `limited` if x is outside. NaN stays NaN.
template <class T>
T clipped(const T& x, const T& lo, const T& hi, Mask<T>& limited) {
  using math::select;
  const Mask<T> above = x > hi;
  const Mask<T> below = x < lo;
  limited = limited || above || below;
  return select(above, hi, select(below, lo, x));
}

/// As above for float, by integer order, which is faster on the chip than comparing floats. NaN
/// stays NaN.
AWMR_SHARED inline float clipped_at_edge(float x, float lo, float hi, bool& limited) {
  const int32_t order = float_math::order_of(x);
  const bool above = order > float_math::order_of(hi);
  if (!above && order >= float_math::order_of(lo)) return x;
  if (float_math::is_nan(x)) return x;
  limited = true;
  return above ? hi : lo;
}
/// As above; usually decided by the leading 16 bits.
inline float clipped(float x, float lo, float hi, bool& limited) {
  return float_math::is_inside(x, lo, hi) ? x : clipped_at_edge(x, lo, hi, limited);
}

/// 2 atan(2 h). `h2` is h^2.
template <class T>
T twice_atan_of_twice(const T& h, const T& /*h2*/) {
  using math::atan;
  return T(2.0) * atan(T(2.0) * h);
}
inline float twice_atan_of_twice(float h, float h2) {
  return float_math::twice_atan_of_twice(h, h2);
}

/// The functions that differ between the two forms.
struct ExactAngle {
  /// 1/(2 (1 + cos d_r)) at d_r = 0.
  template <class T>
  static AWMR_INLINE T straight() {
    return T(0.25);
  }
  /// The steering angle of an h, rad: d_r = 2 atan q = 2 atan(2 h). `h2` is h^2.
  template <class T>
  static AWMR_INLINE T of_h(const T& h, const T& h2) {
    return twice_atan_of_twice(h, h2);
  }
  /// h^2, so that 1/(2 (1 + cos d_r)) = 1/4 + h^2.
  template <class T>
  static AWMR_INLINE T square(const T& h) {
    return h * h;
  }
};
/// Small angles: sin d_r = d_r and cos d_r = 1.
struct SmallAngle {
  template <class T>
  static AWMR_INLINE T straight() {
    return T(0.25);
  }
  template <class T>
  static T of_h(const T& h, const T& /*h2*/) {
    return T(4.0) * h;
  }
  template <class T>
  static T square(const T& /*h*/) {
    return T(0.0);
  }
};

/// Only the front wheels are driven: with t = tan d_r,
///   tau_steering = l_f tau_speed t,   1/(2 cos d_r) = sqrt(1 + t^2)/2
/// which is the same computation with h = t/2 instead of q/2, d_r = atan(2 h), and sqrt(1 + 4
/// h^2)/2 instead of 1/4 + h^2.
struct FrontAngle {
  template <class T>
  static T straight() {
    return T(0.5);
  }
  template <class T>
  static T of_h(const T& h, const T& /*h2*/) {
    using math::atan;
    return atan(T(2.0) * h);
  }
  template <class T>
  static T square(const T& h) {
    using math::sqrt;
    return T(0.5) * sqrt(T(1.0) + T(4.0) * h * h) - T(0.25);
  }
};
/// Only the front wheels are driven, for sin d_r = d_r and cos d_r = 1.
struct FrontSmallAngle {
  template <class T>
  static T straight() {
    return T(0.5);
  }
  template <class T>
  static T of_h(const T& h, const T& /*h2*/) {
    return T(2.0) * h;
  }
  template <class T>
  static T square(const T& /*h*/) {
    return T(0.25);
  }
};

/// tau_speed < 1/16. For float, the leading 16 bits are sufficient: the other bits of 1/16 are 0.
template <class T>
Mask<T> is_weak(const T& tau_speed) {
  return tau_speed < steering_authority_full<T>();
}
inline bool is_weak(float tau_speed) {
  return float_math::leading_order_of(tau_speed) < static_cast<int16_t>(0x3D80);
}

/// The largest |h| at tau_speed: h_max sat(16 tau_speed, [0, 1]). The angle for a moment grows as
/// 1/tau_speed, but is 0 for tau_speed <= 0. A constant limit would make it jump there from the
/// stop to straight. The reduced limit costs at most 1/256 of the steering moment at full thrust.
/// With a single lane it is not read where steering_for() sets steering_powerless.
template <class T>
AWMR_INLINE T steering_limit(const AllocationConstants<T>& c, const T& tau_speed) {
  using math::any;
  using math::select;
  const Mask<T> weak = is_weak(tau_speed);
  if (!any(weak)) return c.h_max;
  T tapered = c.h_max * (tau_speed * (T(1.0) / steering_authority_full<T>()));
  if (!MaskOf<T>::kOneLane) tapered = select(tapered > T(0.0), tapered, T(0.0));
  return select(weak, tapered, c.h_max);
}

/// |h| >= h_max, to which h is clipped. For float, compares bits.
template <class T>
Mask<T> is_at_stop(const T& h, const T& h_max) {
  return h >= h_max || h <= T(-h_max);
}
inline bool is_at_stop(float h, float h_max) {
  return float_math::magnitude_bits(h) == bits_of(h_max);
}

/// The h of the angle that makes a yaw moment at tau_speed, clipped to |h| <= limit:
///   h = q/2 = moment/(2 l_f tau_speed)
/// `half_ratio` is moment/(2 l_f). Sets steering_limited or steering_powerless in `a`.
template <class T>
AWMR_INLINE T steering_for(T limit, const T& tau_speed, const T& half_ratio, Allocation<T>& a) {
  using math::all;
  using math::any;
  using math::select;
  const Mask<T> able =
      !is_weak(tau_speed) || math::is_above(tau_speed, steering_authority_min<T>());
  if (!any(able)) {
    a.steering_powerless = !able;
    return T(0.0);
  }
  if (MaskOf<T>::kOneLane || all(able))
    return clipped(T(math::flushed(half_ratio) / tau_speed), T(-limit), limit, a.steering_limited);
  a.steering_powerless = a.steering_powerless || !able;
  const T h = select(able, T(half_ratio / tau_speed), T(0.0));
  return clipped(h, T(-limit), limit, a.steering_limited);
}

/// The commanded steering angle for h, rad; exactly +-d_max if h was clipped to +-h_max.
template <class Angle, class T>
AWMR_INLINE T angle_of(const AllocationConstants<T>& c, const T& h, const T& h2,
                       Mask<T> is_limited) {
  using math::all;
  using math::any;
  using math::select;
  const Mask<T> stopped = is_limited && is_at_stop(h, c.h_max);
  if (!any(stopped)) return math::saturate(Angle::of_h(h, h2), c.steering_max_rad);
  const T stop_rad = select(math::is_above(h, T(0.0)), c.steering_max_rad, T(-c.steering_max_rad));
  if (MaskOf<T>::kOneLane || all(stopped)) return stop_rad;
  return select(stopped, stop_rad, math::saturate(Angle::of_h(h, h2), c.steering_max_rad));
}

/// Writes the left and right wheel forces into `a`, each clipped to [F'min, F'max]:
///   F'R,L = (tau_speed +- moment/d)/(2 (1 + cos d_r)) = (tau_speed +- moment/d) (1/4 + h^2)
/// `moment_over_track` is moment/d, `quarter` is 1/4 + h^2.
template <class T>
AWMR_INLINE void forces_for(const AllocationConstants<T>& c, const T& tau_speed,
                            const T& moment_over_track, const T& quarter, Allocation<T>& a) {
  const T mean = tau_speed * quarter;
  const T half_difference = moment_over_track * quarter;
  a.force.left = clipped(mean - half_difference, c.force_min, c.force_max, a.force_limited);
  a.force.right = clipped(mean + half_difference, c.force_min, c.force_max, a.force_limited);
}

/// The h with which the steering makes the part of tau_turn that the clipped forces do not make.
/// With quarter = 1/4 + h^2, so that 1 + cos d_r = 1/(2 quarter), the clipped forces make
///   tau_speed = (F'L + F'R)/(2 quarter)
///   tau_diff  = d (F'R - F'L)/(2 quarter)
/// and the remaining moment, tau_turn - tau_diff, requires
///   h = (tau_turn - tau_diff)/(2 l_f tau_speed)
///     = (2 quarter tau_turn - d (F'R - F'L))/(2 l_f (F'L + F'R))
template <class T>
T give_back(const AllocationConstants<T>& c, T limit, const T& tau_turn_m, const T& quarter,
            Allocation<T>& a) {
  const T rest_m =
      (quarter + quarter) * tau_turn_m - c.half_track_m * (a.force.right - a.force.left);
  return steering_for(limit, T(a.force.left + a.force.right), T(rest_m * c.axle_half_inverse), a);
}

/// Implementation of allocate() for both forms.
template <class Angle, class T>
AWMR_INLINE void allocate_by(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                             const AllocationConstants<T>& c, CombinedSplit split,
                             Allocation<T>& a) {
  using math::all;
  using math::any;
  using math::select;
  a = Allocation<T>{};
  const T speed = clipped(tau_speed, c.tau_speed_min, c.tau_speed_max, a.speed_limited);
  const bool combined = mode == YawMode::kCombined;
  const bool redistribute = combined && split == CombinedSplit::kRedistribute;
  T h = T(0.0);
  T h2 = T(0.0);
  T quarter = Angle::template straight<T>();
  if (mode != YawMode::kDifferential) {
    // The combined mode steers for half of tau_turn, so its constant is half of steering's.
    h = steering_for(steering_limit(c, speed), speed,
                     T(tau_turn_m * (combined ? c.axle_quarter_inverse : c.axle_half_inverse)), a);
    h2 = Angle::square(h);
    quarter = T(0.25) + h2;
  }
  const Mask<T> lost = a.steering_limited || a.steering_powerless;
  T over_track = T(0.0);  // the moment made by the forces, over d
  if (redistribute && any(lost)) {
    // The steering makes the part l_f tau_speed q = 2 h l_f tau_speed of tau_turn.
    over_track = (tau_turn_m - h * speed * c.axle_twice_m) * c.half_track_inverse;
    if (!MaskOf<T>::kOneLane) {
      over_track = select(lost, over_track,
                          T(tau_turn_m * (combined ? c.track_inverse : c.half_track_inverse)));
    }
  } else if (mode != YawMode::kSteering) {
    over_track = tau_turn_m * (combined ? c.track_inverse : c.half_track_inverse);
  }
  forces_for(c, speed, over_track, quarter, a);
  if (redistribute && any(a.force_limited && !lost)) {
    const Mask<T> gives = a.force_limited && !lost;
    const Allocation<T> kept = a;
    const T kept_h = h;
    h = give_back(c, steering_limit(c, speed), tau_turn_m, quarter, a);
    if (!MaskOf<T>::kOneLane) {
      h = select(gives, h, kept_h);
      a.steering_limited = select(gives, a.steering_limited, kept.steering_limited);
      a.steering_powerless = select(gives, a.steering_powerless, kept.steering_powerless);
    }
    h2 = Angle::square(h);
  }
  if (mode != YawMode::kDifferential)
    a.steering_rad = angle_of<Angle>(c, h, h2, a.steering_limited);
}

}  // namespace detail

/// The commands that make tau_speed (dimensionless, forward positive) and tau_turn (m,
/// counter-clockwise positive):
///
///   differential   d_r   = 0
///                  F'R,L = tau_speed/4 +- tau_turn/(4 d)
///
///   steering       d_r   = 2 atan(tau_turn/(l_f tau_speed))
///                  F'R,L = tau_speed/(2 (1 + cos d_r))
///
///   combined       d_r   = 2 atan(tau_turn/(2 l_f tau_speed))
///                  F'R,L = tau_speed/(2 (1 + cos d_r)) +- tau_turn/(4 d (1 + cos d_r))
///                                                                          [paper (42), corrected]
/// Corrected: the paper prints the combined mode with L and R swapped against its (41), and with d
/// instead of l_f in d_r. Its small angles, sin d_r = d_r and cos d_r = 1, are not necessary. With
/// them (AllocationForm::kPaper), tan(d_r/2) becomes d_r/2 and the forces are those at d_r = 0,
/// which omits 3 % of the thrust at 20 deg.
///
/// `split` applies to the combined mode: with kRedistribute, the part that one path cannot make
/// because of its limits goes to the other. The result is finite for finite input.
template <class T>
AWMR_INLINE void allocate(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                          const AllocationConstants<T>& c, CombinedSplit split, Allocation<T>& a) {
  detail::allocate_by<detail::ExactAngle>(mode, tau_speed, tau_turn_m, c, split, a);
}

/// Converts constants of the exact form to the small-angle form, AllocationForm::kPaper.
template <class T>
AllocationConstants<T> small_angle_form(AllocationConstants<T> c) {
  c.h_max = T(0.25) * c.steering_max_rad;
  return c;
}

/// allocate() with only the front wheels driven, from the constants of four driven wheels:
///
///   differential   d_r   = 0
///                  F'R,L = tau_speed/2 +- tau_turn/(2 d)
///
///   steering       d_r   = atan(tau_turn/(l_f tau_speed))
///                  F'R,L = tau_speed/(2 cos d_r)
///
///   combined       d_r   = atan(tau_turn/(2 l_f tau_speed))
///                  F'R,L = tau_speed/(2 cos d_r) +- tau_turn/(4 d cos d_r)
///
/// the inverse of front_wheel_forces() in model/dynamics.h; `form` kPaper: for small angles.
template <class T>
void allocate_to_front(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                       AllocationConstants<T> c, CombinedSplit split, AllocationForm form,
                       Allocation<T>& a) {
  using math::cos;
  using math::sin;
  c.tau_speed_min = T(0.5) * c.tau_speed_min;
  c.tau_speed_max = T(0.5) * c.tau_speed_max;
  const T stop_rad = c.steering_max_rad;
  if (form == AllocationForm::kPaper) {
    c.h_max = T(0.5) * stop_rad;
    detail::allocate_by<detail::FrontSmallAngle>(mode, tau_speed, tau_turn_m, c, split, a);
  } else {
    c.h_max = T(0.5) * sin(stop_rad) / cos(stop_rad);
    detail::allocate_by<detail::FrontAngle>(mode, tau_speed, tau_turn_m, c, split, a);
  }
}

/// allocate() from the limits, in their form, where computing time does not matter. u, m/s, is the
/// speed, on which the limits depend if the motors have back-EMF. The chip supports only the exact
/// form and four motors.
template <class T>
Allocation<T> allocate(YawMode mode, const T& tau_speed, const T& tau_turn_m,
                       const AllocationLimits<T>& limits, const T& u_mps = T(0.0)) {
  Allocation<T> a{};
  AllocationConstants<T> c = prepared(limits);
#ifndef __AVR__
  if (limits.back_emf_s_per_m > T(0.0)) c = at_speed(c, limits.back_emf_s_per_m, u_mps);
  if (!limits.is_rear_driven) {
    allocate_to_front(mode, tau_speed, tau_turn_m, c, limits.split, limits.form, a);
    return a;
  }
  if (limits.form == AllocationForm::kPaper) {
    detail::allocate_by<detail::SmallAngle>(mode, tau_speed, tau_turn_m, small_angle_form(c),
                                            limits.split, a);
    return a;
  }
#else
  static_cast<void>(u_mps);
#endif
  allocate(mode, tau_speed, tau_turn_m, c, limits.split, a);
  return a;
}

}  // namespace awmr
