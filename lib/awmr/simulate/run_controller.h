/// The controller of a run after its guidance, once for a run by itself and for a register of runs:
/// laws or what replaces them, disturbance observer, allocation, motor commands. Private to this folder.
#pragma once

#include "awmr/control/control_step.h"
#include "awmr/control/heading_lqi.h"
#include "awmr/control/motor_command.h"

namespace awmr {

/// Constants of a run. The flags are the same for all runs of a register.
template <class T>
struct RunController {
  PreparedController<T> laws;
  SteeringGeometry geometry;
  YawSplit<T> split;
  T dead_zone;         ///< F'0
  T back_emf_s_per_m;  ///< k_e
  T sample_time_s;
  bool is_open_loop;     ///< tau_speed and tau_turn_m are commanded, and nothing is measured
  bool holds_tau_speed;  ///< tau_speed replaces the speed law
  bool is_lqi;           ///< an LQI replaces the sliding mode
  bool is_observed;
  T tau_speed, tau_turn_m;
  LqiGains<T> lqi;
  Observers<T> observers;
};

/// State of a run's controller between two samples.
template <class T>
struct RunControllerState {
  ObserversState<T> observed;
  LqiState<T> lqi;
};

/// Commands of one sample.
template <class T>
struct RunCommand {
  T tau_speed;          ///< as in Command
  T tau_turn_m;         ///< as in Command
  SideForces<T> force;  ///< of the motors, with dead zone and back-EMF
  T steering_rad;
};

/// The state in which the observers see no disturbance.
template <class T>
RunControllerState<T> start_controller(const RunController<T>& c, const Measurement<T>& m) {
  return {start_observers(c.observers, observed_motion(c.laws, m).momentum), {T(0.0), T(0.0)}};
}

/// Computes the commands of one sample. Call it once per sample, in order.
template <class T>
RunCommand<T> command_sample(const RunController<T>& c, const Measurement<T>& measured,
                             const Reference<T>& ref, RunControllerState<T>& state) {
  const T zero = T(0.0);
  const Measurement<T> m = c.is_open_loop ? Measurement<T>{zero, zero, zero, zero} : measured;
  const AllocationConstants<T>& at_rest = c.laws.constants.allocation;
  const AllocationConstants<T> limits =
      at_speed(at_rest, c.back_emf_s_per_m, m.u_mps, c.geometry.driven_wheels());
  RunCommand<T> out{c.tau_speed, c.tau_turn_m, {zero, zero}, zero};
  if (!c.is_open_loop) {
    if (!c.holds_tau_speed) out.tau_speed = speed_law(c.laws, m, ref);
    out.tau_turn_m =
        c.is_lqi ? lqi_law(c.laws.yaw, c.laws.constants.inertia_norm, c.lqi, m, ref, state.lqi)
                 : heading_law(c.laws, m, ref);
  }
  Allocation<T> a;
  allocate_compensated(c.is_observed ? &c.observers : nullptr, c.laws, m, c.sample_time_s,
                       {c.geometry, c.split, limits, out.tau_speed, out.tau_turn_m, a},
                       &state.observed);
  if (c.is_lqi) {
    integrate_error(out.tau_turn_m, a, allocated_forces(c.geometry, limits, a), c.sample_time_s,
                    state.lqi);
  }
  out.force = motor_commands(a.force, at_rest, c.dead_zone, c.back_emf_s_per_m, m.u_mps, m.r_radps);
  out.steering_rad = a.steering_rad;
  return out;
}

}  // namespace awmr
