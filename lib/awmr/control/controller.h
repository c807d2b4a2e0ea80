/// Sliding-mode heading and speed laws and the allocation, one step at a time. Freestanding C++14:
/// the same source runs in the simulator (double), in its float version and on the AVR.
#pragma once

#include "awmr/control/allocation.h"
#include "awmr/control/flash.h"
#include "awmr/control/resistance_table.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/core/units.h"
#include "awmr/model/gains.h"
#include "awmr/model/resistance.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Model and gains of the controller. G is the type of a resistance: the law itself, or a table of
/// it (resistance_table.h). It must return g for a speed.
template <class T, class G = Resistance<T>>
struct Controller {
  G surge;                     ///< g1 of the model, dimensionless, of u in m/s: fed forward
  G yaw;                       ///< g3 of the model, m, of r in rad/s: fed forward
  T mass_norm;                 ///< m' of the model, s^2/m, > 0
  T inertia_norm;              ///< I'z of the model, s^2 m, > 0
  Gains<T> gains;              ///< tuned gains
  AllocationLimits<T> limits;  ///< limits of the vehicle
};

/// Measured motion of the vehicle at one sample.
template <class T>
struct Measurement {
  T psi_rad;  ///< psi, rad: heading, counter-clockwise from the world's x axis; any number of turns
  T u_mps;    ///< u, m/s: surge speed, forward positive
  T v_mps;    ///< v, m/s: sway speed, left positive; 0 without a sensor
  T r_radps;  ///< r, rad/s: yaw rate, counter-clockwise positive
};

/// Reference of the laws at one sample.
template <class T>
struct Reference {
  T psi_rad;           ///< psi_d, rad: desired heading; any number of turns
  T psi_rate_radps;    ///< psi_d_dot, rad/s: 0 for a constant heading
  T psi_accel_radps2;  ///< psi_d_ddot, rad/s^2: 0 for a constant heading
  T speed_mps;         ///< u_d, m/s: desired speed, forward positive
  T accel_mps2;        ///< u_d_dot, m/s^2: 0 for a constant speed
};

/// Outputs of the laws, and the resulting commands.
template <class T>
struct Command {
  T tau_speed;               ///< dimensionless, forward positive: requested, before any limit
  T tau_turn_m;              ///< m, counter-clockwise positive: requested, before any limit
  T sliding_radps;           ///< S, rad/s: 0 on the sliding surface
  Allocation<T> allocation;  ///< forces and angle, within their limits
};

/// Maximum number of turns that wrap_angle removes one by one; above it uses atan2.
constexpr int kTurnsOneByOne = 64;

/// The equivalent angle in (-pi, pi], in constant time. NaN stays NaN, and an infinite angle
/// becomes NaN.
template <class T>
T wrap_angle(T angle_rad) {
  using math::atan2;
  using math::cos;
  using math::sin;
  const T few = T(2.0 * kTurnsOneByOne) * pi<T>();
  // NaN compares false with every bound, so the loops below would not end.
  if (!(angle_rad < few && angle_rad > -few)) angle_rad = atan2(sin(angle_rad), cos(angle_rad));
  if (!(angle_rad < few && angle_rad > -few)) return angle_rad;
  while (angle_rad > pi<T>()) angle_rad -= T(2.0) * pi<T>();
  while (!(angle_rad > -pi<T>())) angle_rad += T(2.0) * pi<T>();
  return angle_rad;
}
/// For float, computing time is the same for every angle, as a control step on the chip requires.
template <>
inline float wrap_angle(float angle_rad) {
  return float_math::wrapped(angle_rad);
}

/// wrap_angle() as a called function, for guidance, where the cost of a call does not matter.
template <class T>
AWMR_CALLED T called_wrap_angle(const T& angle_rad) {
  return wrap_angle(angle_rad);
}

/// Constants of the laws and the allocation, computed once from model, gains and limits, with m'
/// and I'z multiplied in. All members are of type T, so there is no padding and a check sum can
/// cover it.
template <class T>
struct ControlConstants {
  T mass_norm;      ///< m', s^2/m
  T inertia_norm;   ///< I'z, s^2 m
  T lambda;         ///< lambda, 1/s
  T heading_rate;   ///< I'z lambda, s m
  T heading_slope;  ///< I'z mu/epsilon, s m
  T heading_limit;  ///< I'z mu, m
  T speed_slope;    ///< m' mu_s/eps_s, s/m
  T speed_limit;    ///< m' mu_s, dimensionless
  AllocationConstants<T> allocation;
};

/// The form of the controller on the chip.
template <class T, class G = Resistance<T>>
struct PreparedController {
  G surge;  ///< g1
  G yaw;    ///< g3
  ControlConstants<T> constants;
};

/// Computes the constants of a controller.
template <class T, class G>
PreparedController<T, G> prepared(const Controller<T, G>& c) {
  return {
      c.surge,
      c.yaw,
      {c.mass_norm, c.inertia_norm, c.gains.heading.lambda, c.inertia_norm * c.gains.heading.lambda,
       c.inertia_norm * (c.gains.heading.mu / c.gains.heading.epsilon),
       c.inertia_norm * c.gains.heading.mu,
       c.mass_norm * (c.gains.speed.mu / c.gains.speed.epsilon), c.mass_norm * c.gains.speed.mu,
       prepared(c.limits)}};
}

/// Resistance that a law adds to its command, at the speed w:
///   g(w)                                        for |w| >= rest_speed
///   g(rest_speed) sat((w + intent)/rest_speed)  below
/// The second line is for curves that jump at rest (feed_forward() in resistance.h). There the
/// curve does not give the force that starts the motion, but the sign of `intent`, the speed error,
/// gives its direction.
template <class T>
T fed_forward(const Resistance<T>& law, const T& speed, const T& intent) {
  using math::abs;
  using math::all;
  using math::any;
  using math::select;
  const Mask<T> rests = abs(speed) < law.rest_speed;
  if (!any(rests)) return law(speed);
  const T held =
      law.at(law.rest_speed) * math::saturate(T((speed + intent) / law.rest_speed), T(1.0));
  if (MaskOf<T>::kOneLane || all(rests)) return held;
  return select(rests, held, law(speed));
}
/// As above, for a table.
inline float fed_forward(const RestingTable& law, const float& speed, const float& intent) {
  if (!law.is_resting(speed)) return law.table(speed);
  return law.at_rest * math::saturate((speed + intent) / law.rest_speed, 1.0F);
}
/// As above, for a table without a jump at rest; `intent` is not used.
template <class T, class G>
T fed_forward(const G& table, const T& speed, const T&) {
  return table(speed);
}

/// The sliding variable of the heading law, rad/s:
///   S     = e_dot + lambda e
///   e     = wrap(psi_d - psi)
///   e_dot = psi_d_dot - r                                                        [paper (81)-(82)]
template <class T>
T sliding_surface(const HeadingGains<T>& gains, const Measurement<T>& m, const Reference<T>& ref) {
  return ref.psi_rate_radps - m.r_radps + gains.lambda * wrap_angle(ref.psi_rad - m.psi_rad);
}

/// The heading law, m:
///   tau_turn = g3(r) + I'z (psi_d_ddot + lambda (psi_d_dot - r) + mu sat(S/eps))
///   sat(z)   = z for |z| <= 1, sgn z beyond                           [paper (84)-(89), corrected]
/// Corrected: (84)-(85) print r_ddot for r_dot; (88)-(89) print psi_d_dot - r_dot for psi_d_dot -
/// r; in (87), as in (78), sat has the condition |e| <= eps instead of |S| <= eps. The printed law
/// also subtracts the disturbance, which is unknown: it is omitted, and mu must dominate it.
template <class T, class G>
T heading_law(const Controller<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  const HeadingGains<T>& gains = c.gains.heading;
  const T error_rate = ref.psi_rate_radps - m.r_radps;
  const T s = error_rate + gains.lambda * wrap_angle(ref.psi_rad - m.psi_rad);
  // mu sat(S/eps) = sat(S mu/eps, mu)
  const T correction = math::saturate(T(gains.mu / gains.epsilon * s), gains.mu);
  return fed_forward(c.yaw, m.r_radps, s) +
         c.inertia_norm * (ref.psi_accel_radps2 + gains.lambda * error_rate + correction);
}

/// The same law with the chip's constants, where each operation counts:
///   tau_turn = g3(r) + I'z lambda (psi_d_dot - r) + sat(S I'z mu/eps, I'z mu) + I'z psi_d_ddot
/// Terms that are 0 for a constant heading are skipped.
template <class T, class G>
AWMR_INLINE T heading_law(const PreparedController<T, G>& c, const Measurement<T>& m,
                          const Reference<T>& ref) {
  const ControlConstants<T>& k = c.constants;
  const T error_rate = math::difference(ref.psi_rate_radps, m.r_radps);
  const T s = error_rate + k.lambda * wrap_angle(ref.psi_rad - m.psi_rad);
  const T correction = math::saturate(T(k.heading_slope * s), k.heading_limit);
  const T held = fed_forward(c.yaw, m.r_radps, s) + (k.heading_rate * error_rate + correction);
  return math::plus_product(held, k.inertia_norm, ref.psi_accel_radps2);
}

/// The end of [0, u_d + eps_s], or [u_d - eps_s, 0], that lies on the side of u. Rarely called.
template <class T>
AWMR_CALLED T fastest_fed_forward(const T& u_mps, const T& u_d_mps, const T& epsilon_mps) {
  using math::select;
  return select(u_mps > T(0.0), math::larger(T(u_d_mps + epsilon_mps), T(0.0)),
                T(-math::larger(T(epsilon_mps - u_d_mps), T(0.0))));
}

/// Speed whose resistance the speed law feeds forward, m/s:
///   w = 0                     at u_d = 0
///   w = max(0, u_d + eps_s)   where the vehicle is faster than that, forward; backward likewise
///   w = u                     else
/// With g1(u) everywhere, a vehicle that a slope pulls would be driven along the slope by g1(u) - m' mu_s: without
/// end where it is faster than u_d, and at u_d = 0 wherever g1(u) is more than the correction. `wanted` and `limit`
/// are the correction before and at its saturation, `epsilon` a function that gives eps_s.
template <class T, class Epsilon>
AWMR_INLINE T fed_forward_speed(const T& u_mps, const Reference<T>& ref, const T& error_mps,
                                const T& wanted, const T& limit, const Epsilon& epsilon) {
  using math::any;
  using math::select;
  T w_mps = u_mps;
  const Mask<T> too_fast = math::is_opposite(u_mps, error_mps) && math::is_beyond(wanted, limit);
  if (any(too_fast)) {
    w_mps = select(too_fast, fastest_fed_forward(u_mps, ref.speed_mps, T(epsilon())), w_mps);
  }
  const Mask<T> stands = math::is_zero(ref.speed_mps);
  return any(stands) ? select(stands, T(0.0), w_mps) : w_mps;
}

/// The speed law, dimensionless:
///   tau_speed = g1(w) - m' r v + m' (u_d_dot + mu_s sat(e_u/eps_s)),   e_u = u_d - u
///                                                                    [paper (97)-(102), corrected]
/// Corrected: (100)-(102) are printed without u_d_dot, which (99) has; the disturbance drops out as
/// in the heading law. The paper has g1(u) at every speed; w is fed_forward_speed().
template <class T, class G>
T speed_law(const Controller<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  const SpeedGains<T>& gains = c.gains.speed;
  const T error = ref.speed_mps - m.u_mps;
  const T wanted = gains.mu / gains.epsilon * error;
  const T correction = math::saturate(wanted, gains.mu);
  const T w_mps =
      fed_forward_speed(m.u_mps, ref, error, wanted, gains.mu, [&gains] { return gains.epsilon; });
  return fed_forward(c.surge, w_mps, error) +
         c.mass_norm * (ref.accel_mps2 + correction - m.r_radps * m.v_mps);
}

/// The same by the constants of the chip:
///   tau_speed = g1(w) + m' (u_d_dot - r v) + sat(e_u m' mu_s/eps_s, m' mu_s)
template <class T, class G>
AWMR_INLINE T speed_law(const PreparedController<T, G>& c, const Measurement<T>& m,
                        const Reference<T>& ref) {
  const ControlConstants<T>& k = c.constants;
  const T error = ref.speed_mps - m.u_mps;
  const T wanted = k.speed_slope * error;
  const T correction = math::saturate(wanted, k.speed_limit);
  const T w_mps = fed_forward_speed(m.u_mps, ref, error, wanted, k.speed_limit,
                                    [&k] { return T(k.speed_limit / k.speed_slope); });
  const T accel_mps2 = math::difference(ref.accel_mps2, T(m.r_radps * m.v_mps));
  return fed_forward(c.surge, w_mps, error) +
         math::plus_product(correction, k.mass_norm, accel_mps2);
}

/// Computes both laws and the allocation for one sample.
template <class T, class G>
Command<T> control_step(const Controller<T, G>& c, YawMode mode, const Measurement<T>& m,
                        const Reference<T>& ref) {
  Command<T> command{};
  command.tau_speed = speed_law(c, m, ref);
  command.tau_turn_m = heading_law(c, m, ref);
  command.sliding_radps = sliding_surface(c.gains.heading, m, ref);
  command.allocation = allocate(mode, command.tau_speed, command.tau_turn_m, c.limits, m.u_mps);
  return command;
}

}  // namespace awmr
