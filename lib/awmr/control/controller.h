/// The sliding-mode heading and speed laws and the allocation, one step at a time. Freestanding
/// C++14: the same source runs in the simulator (double), in its float twin and on the AVR.
#pragma once

#include "awmr/control/allocation.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/core/units.h"
#include "awmr/model/gains.h"
#include "awmr/model/resistance.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// G is the form in which the resistance is known: the law itself, or a table of it
/// (resistance_table.h); whatever gives g for a speed.
template <class T, class G = Resistance<T>>
struct Controller {
  G surge;         ///< g1, dimensionless, of u in m/s
  G yaw;           ///< g3, m, of r in rad/s
  T mass_norm;     ///< m', s^2/m
  T inertia_norm;  ///< I'z, s^2 m
  Gains<T> gains;
  AllocationLimits<T> limits;
};

template <class T>
struct Measurement {
  T psi_rad;
  T u_mps;
  T v_mps;
  T r_radps;
};

template <class T>
struct Reference {
  T psi_rad;           ///< psi_d
  T psi_rate_radps;    ///< psi_d_dot
  T psi_accel_radps2;  ///< psi_d_ddot
  T speed_mps;         ///< u_d
  T accel_mps2;        ///< u_d_dot
};

template <class T>
struct Command {
  T tau_speed;
  T tau_turn_m;
  T sliding_radps;  ///< S
  Allocation<T> allocation;
};

/// The angle's equal in (-pi, pi].
template <class T>
T wrap_angle(T angle_rad) {
  while (angle_rad > pi<T>()) angle_rad -= T(2.0) * pi<T>();
  while (!(angle_rad > -pi<T>())) angle_rad += T(2.0) * pi<T>();
  return angle_rad;
}
/// float in constant time, which a control step on the chip needs.
template <>
inline float wrap_angle(float angle_rad) {
  return float_math::wrapped(angle_rad);
}

/// What the laws and the allocation need of model, gains and limits, computed once; of Ts only.
template <class T>
struct ControlConstants {
  T mass_norm;
  T inertia_norm;
  T lambda;
  T heading_mu;
  T heading_slope;  ///< mu/epsilon, 1/s
  T speed_mu;
  T speed_slope;  ///< mu_s/epsilon_s, 1/s
  AllocationConstants<T> allocation;
};

/// A controller as the chip holds it.
template <class T, class G = Resistance<T>>
struct PreparedController {
  G surge;
  G yaw;
  ControlConstants<T> constants;
};

template <class T, class G>
PreparedController<T, G> prepared(const Controller<T, G>& c) {
  return {c.surge,
          c.yaw,
          {c.mass_norm, c.inertia_norm, c.gains.heading.lambda, c.gains.heading.mu,
           c.gains.heading.mu / c.gains.heading.epsilon, c.gains.speed.mu,
           c.gains.speed.mu / c.gains.speed.epsilon, prepared(c.limits)}};
}

/// The resistance fed forward. At rest a curve that jumps there (feed_forward() in resistance.h)
/// says nothing of the force it takes to move; which way the vehicle is to move, `intent`, does:
///   g(w) outside of the chord;  g(rest) sat((w + intent)/rest) on it
template <class T>
T fed_forward(const Resistance<T>& law, const T& speed, const T& intent) {
  using math::abs;
  if (!(abs(speed) < law.rest_speed)) return law(speed);
  return law.at(law.rest_speed) * math::saturate(T((speed + intent) / law.rest_speed), T(1.0));
}
template <class T, class G>
T fed_forward(const G& table, const T& speed, const T&) {
  return table(speed);
}

/// S = e_dot + lambda e,  e = wrap(psi_d - psi),  e_dot = psi_d_dot - r                 [paper
/// (82)]
template <class T>
T sliding_surface(const HeadingGains<T>& gains, const Measurement<T>& m, const Reference<T>& ref) {
  return ref.psi_rate_radps - m.r_radps + gains.lambda * wrap_angle(ref.psi_rad - m.psi_rad);
}

/// tau_turn = g3(r) + I'z (psi_d_ddot + lambda (psi_d_dot - r) + mu sat(S/eps))
/// [paper (89), corrected: (84)-(85) write r_ddot for r_dot, (88)-(89) psi_d_dot - r_dot for
/// psi_d_dot - r; (78), (87): the condition of sat is on |S| <= eps, not on |e|. The disturbance is
/// unknown and drops out; mu has to dominate it.]
template <class T, class G>
T heading_law(const PreparedController<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  const ControlConstants<T>& k = c.constants;
  const T error_rate = ref.psi_rate_radps - m.r_radps;
  const T s = error_rate + k.lambda * wrap_angle(ref.psi_rad - m.psi_rad);
  // mu sat(S/eps) = sat(S mu/eps, mu)
  const T correction = math::saturate(k.heading_slope * s, k.heading_mu);
  return fed_forward(c.yaw, m.r_radps, s) +
         k.inertia_norm * (ref.psi_accel_radps2 + k.lambda * error_rate + correction);
}
template <class T, class G>
T heading_law(const Controller<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  return heading_law(prepared(c), m, ref);
}

/// tau_speed = g1(u) - m' r v + m' (u_d_dot + mu_s sat((u_d - u)/eps_s))                [paper
/// (102)]
template <class T, class G>
T speed_law(const PreparedController<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  const ControlConstants<T>& k = c.constants;
  const T error = ref.speed_mps - m.u_mps;
  const T correction = math::saturate(k.speed_slope * error, k.speed_mu);
  return fed_forward(c.surge, m.u_mps, error) +
         k.mass_norm * (ref.accel_mps2 + correction - m.r_radps * m.v_mps);
}
template <class T, class G>
T speed_law(const Controller<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  return speed_law(prepared(c), m, ref);
}

template <class T, class G>
Command<T> control_step(const Controller<T, G>& c, YawMode mode, const Measurement<T>& m,
                        const Reference<T>& ref) {
  const PreparedController<T, G> ready = prepared(c);
  Command<T> command{};
  command.tau_speed = speed_law(ready, m, ref);
  command.tau_turn_m = heading_law(ready, m, ref);
  command.sliding_radps = sliding_surface(c.gains.heading, m, ref);
  allocate(mode, command.tau_speed, command.tau_turn_m, ready.constants.allocation, c.limits.split,
           command.allocation);
  return command;
}

}  // namespace awmr
