/// The sliding-mode heading and speed laws and the allocation, one step at a time. Freestanding C++14:
/// the same source runs in the simulator (double), in its float twin and on the AVR.
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
  G surge;              ///< g1, dimensionless, of u in m/s
  G yaw;                ///< g3, m, of r in rad/s
  T mass_norm;          ///< m', s^2/m
  T inertia_norm;       ///< I'z, s^2 m
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
  T psi_rad;              ///< psi_d
  T psi_rate_radps;       ///< psi_d_dot
  T psi_accel_radps2;     ///< psi_d_ddot
  T speed_mps;            ///< u_d
  T accel_mps2;           ///< u_d_dot
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

/// S = e_dot + lambda e,  e = wrap(psi_d - psi),  e_dot = psi_d_dot - r                 [paper (82)]
template <class T>
T sliding_surface(const HeadingGains<T>& gains, const Measurement<T>& m, const Reference<T>& ref) {
  return ref.psi_rate_radps - m.r_radps + gains.lambda * wrap_angle(ref.psi_rad - m.psi_rad);
}

/// tau_turn = g3(r) + I'z (psi_d_ddot + lambda (psi_d_dot - r) + mu sat(S/eps))
/// [paper (89), corrected: (84)-(85) write r_ddot for r_dot, (88)-(89) psi_d_dot - r_dot for
/// psi_d_dot - r; (78), (87): the condition of sat is on |S| <= eps, not on |e|. The disturbance is
/// unknown and drops out; mu has to dominate it.]
template <class T, class G>
T heading_law(const Controller<T, G>& c, const T& sliding_radps, const Measurement<T>& m,
              const Reference<T>& ref) {
  const T correction =
      c.gains.heading.mu * math::saturate(sliding_radps / c.gains.heading.epsilon, T(1.0));
  return c.yaw(m.r_radps) +
         c.inertia_norm * (ref.psi_accel_radps2 +
                           c.gains.heading.lambda * (ref.psi_rate_radps - m.r_radps) + correction);
}
template <class T, class G>
T heading_law(const Controller<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  return heading_law(c, sliding_surface(c.gains.heading, m, ref), m, ref);
}

/// tau_speed = g1(u) - m' r v + m' (u_d_dot + mu_s sat((u_d - u)/eps_s))                [paper (102)]
template <class T, class G>
T speed_law(const Controller<T, G>& c, const Measurement<T>& m, const Reference<T>& ref) {
  const T error = ref.speed_mps - m.u_mps;
  const T correction = c.gains.speed.mu * math::saturate(error / c.gains.speed.epsilon, T(1.0));
  return c.surge(m.u_mps) - c.mass_norm * m.r_radps * m.v_mps +
         c.mass_norm * (ref.accel_mps2 + correction);
}

template <class T, class G>
Command<T> control_step(const Controller<T, G>& c, YawMode mode, const Measurement<T>& m,
                        const Reference<T>& ref) {
  Command<T> command{};
  command.tau_speed = speed_law(c, m, ref);
  command.sliding_radps = sliding_surface(c.gains.heading, m, ref);
  command.tau_turn_m = heading_law(c, command.sliding_radps, m, ref);
  command.allocation = allocate(mode, command.tau_speed, command.tau_turn_m, c.limits);
  return command;
}

}  // namespace awmr
