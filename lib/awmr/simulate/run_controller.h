/// The simulated controller of a run: computes the commands of a sample from measurements and
/// reference. It consists of heading and speed law (or LQI, constant thrust, open loop),
/// disturbance observer and allocation. The templates serve a single run or a batch of runs.
/// Private to this folder.
#pragma once

#include "awmr/control/control_step.h"
#include "awmr/control/heading_lqi.h"
#include "awmr/control/motor_command.h"

namespace awmr {

/// Properties that the controllers of all runs share.
struct ControllerSetup {
  SteeringGeometry geometry = kFourWheelSteering;
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// constant tau_speed and tau_turn_m replace speed and heading law
  bool is_open_loop = false;
  bool holds_tau_speed = false;  ///< a constant tau_speed replaces the speed law
  bool is_lqi = false;           ///< an LQI heading law replaces the sliding mode
  bool is_observed = false;      ///< any run has an observer
  bool anti_windup = true;       ///< Observers::anti_windup
  double sample_time_s = 0.0;
};

/// Constants of the controller of a run. All members are of type T.
template <class T>
struct RunController {
  PreparedController<T> laws;
  T steering_share;         ///< fraction of the yaw moment that steering makes (YawSplit)
  T dead_zone;              ///< dead zone F'0 of the motors, divided by F_max
  T back_emf_s_per_m;       ///< k_e of the motors, s/m
  T tau_speed, tau_turn_m;  ///< constants that replace laws, see is_open_loop and holds_tau_speed
  LqiGains<T> lqi;
  DisturbanceObserver<T> yaw_observer, surge_observer;  ///< bandwidth 0: none
};

/// State of the controller of a run between two samples.
template <class T>
struct RunControllerState {
  ObserversState<T> observed;
  LqiState<T> lqi;
};

/// Commands of one sample.
template <class T>
struct RunCommand {
  T tau_speed;          ///< as in AllocationRequest
  T tau_turn_m;         ///< as in AllocationRequest
  SideForces<T> force;  ///< motor commands, with dead zone and back-EMF compensated
  T steering_rad;
};

template <class T>
Observers<T> observers_of(const ControllerSetup& setup, const RunController<T>& c) {
  return {c.yaw_observer, c.surge_observer, setup.anti_windup};
}

/// Returns yaw_split() of the run's yaw mode. steering_share identifies the mode: 0 is
/// differential, 1/2 combined, 1 steering.
template <class T>
YawSplit<T> yaw_split_of(const ControllerSetup& setup, const RunController<T>& c) {
  const Mask<T> may = Mask<T>(setup.split == CombinedSplit::kRedistribute);
  return {c.steering_share, may && c.steering_share > T(0.0) && c.steering_share < T(1.0)};
}

/// Returns the initial state, in which the estimated disturbance is 0.
template <class T>
RunControllerState<T> start_controller(const ControllerSetup& setup, const RunController<T>& c,
                                       const Measurement<T>& m) {
  return {start_observers(observers_of(setup, c), observed_motion(c.laws, m).momentum),
          {T(0.0), T(0.0)}};
}

/// Returns the speed whose back-EMF the motor commands make up, m/s: made_up_speed(), or the
/// measured speed if no speed is commanded.
template <class T>
T back_emf_speed(const ControllerSetup& setup, const RunController<T>& c, const Measurement<T>& m,
                 const Reference<T>& ref) {
  using math::any;
  const bool has_speed = !setup.is_open_loop && !setup.holds_tau_speed;
  if (!has_speed || !any(c.back_emf_s_per_m > T(0.0))) return m.u_mps;
  return made_up_speed(c.laws.constants.laws, m.u_mps, ref.speed_mps);
}

/// Computes the commands of one sample. Call it once per sample, in order.
template <class T>
RunCommand<T> command_sample(const ControllerSetup& setup, const RunController<T>& c,
                             const Measurement<T>& measured, const Reference<T>& ref,
                             RunControllerState<T>& state) {
  const T zero = T(0.0);
  const Measurement<T> m = setup.is_open_loop ? Measurement<T>{zero, zero, zero, zero} : measured;
  const AllocationConstants<T>& at_rest = c.laws.constants.allocation;
  const T emf_mps = back_emf_speed(setup, c, m, ref);
  const AllocationConstants<T> limits =
      at_speed(at_rest, c.back_emf_s_per_m, emf_mps, setup.geometry.driven_wheels());
  RunCommand<T> out{c.tau_speed, c.tau_turn_m, {zero, zero}, zero};
  if (!setup.is_open_loop) {
    if (!setup.holds_tau_speed) out.tau_speed = speed_law(c.laws, m, ref);
    out.tau_turn_m =
        setup.is_lqi ? lqi_law(c.laws.yaw, c.laws.constants.inertia_norm, c.lqi, m, ref, state.lqi)
                     : heading_law(c.laws, m, ref);
  }
  const T sample_time_s = T(setup.sample_time_s);
  const Observers<T> observers = observers_of(setup, c);
  const YawSplit<T> split = yaw_split_of(setup, c);
  Allocation<T> a;
  allocate_compensated(setup.is_observed ? &observers : nullptr, c.laws, m, sample_time_s,
                       {setup.geometry, split, limits, out.tau_speed, out.tau_turn_m, a},
                       &state.observed);
  if (setup.is_lqi) {
    integrate_error(out.tau_turn_m, a, allocated_forces(setup.geometry, limits, a), sample_time_s,
                    state.lqi);
  }
  out.force = motor_commands(a.force, at_rest, c.dead_zone, c.back_emf_s_per_m, emf_mps, m.r_radps);
  out.steering_rad = a.steering_rad;
  return out;
}

}  // namespace awmr
