#include "awmr/simulate/laws.h"

#include "awmr/simulate/one_run.h"

namespace awmr {

Laws::Laws(const Controller<double>& controller, const Scenario& scenario, YawMode mode,
           double sample_time_s, const Measurement<double>& start)
    : controller_(controller_in(scenario, controller)),
      mode_(mode),
      held_tau_speed_(scenario.held_tau_speed()),
      sample_time_s_(sample_time_s) {
  const Observers<double> observers = observers_in(scenario, controller.gains);
  if (observers.yaw.bandwidth_radps > 0.0) {
    observers_ = observers;
    observed_ = start_observers(*observers_, motion_of(start).momentum);
  }
  if (scenario.control.lqi) lqi_ = lqi_gains(*scenario.control.lqi, controller_.inertia_norm);
}

Command<double> Laws::open_loop(const OpenLoop& open) const {
  Command<double> command{open.tau_speed, open.tau_turn_m, 0.0, {}};
  command.allocation = allocate(mode_, command.tau_speed, command.tau_turn_m, controller_.limits);
  return command;
}

Command<double> Laws::follow(const Measurement<double>& m, const Reference<double>& reference) {
  Command<double> command = control_step(controller_, mode_, m, reference);
  if (held_tau_speed_) {
    command.tau_speed = *held_tau_speed_;
    reallocate(m, command);
  }
  if (lqi_) {
    command.tau_turn_m =
        lqi_law(controller_.yaw, controller_.inertia_norm, *lqi_, m, reference, lqi_state_);
    reallocate(m, command);
  }
  if (observers_) take_off_disturbance(m, command);
  if (lqi_) {
    integrate_error(command.tau_turn_m, command.allocation, made_of(command), sample_time_s_,
                    lqi_state_);
  }
  return command;
}

ObservedMotion<double> Laws::motion_of(const Measurement<double>& m) const {
  return {{controller_.mass_norm * m.u_mps, controller_.inertia_norm * m.r_radps},
          {controller_.surge(m.u_mps), controller_.yaw(m.r_radps)},
          controller_.mass_norm * m.r_radps * m.v_mps};
}

void Laws::reallocate(const Measurement<double>& m, Command<double>& command) const {
  command.allocation =
      allocate(mode_, command.tau_speed, command.tau_turn_m, controller_.limits, m.u_mps);
}

GeneralisedForces<double> Laws::made_of(const Command<double>& command) const {
  return delivered_forces(controller_.limits, command.allocation.force,
                          command.allocation.steering_rad);
}

void Laws::take_off_disturbance(const Measurement<double>& m, Command<double>& command) {
  const ObservedMotion<double> motion = motion_of(m);
  const AxisForces<double> disturbance = estimate(*observers_, motion, observed_);
  command.tau_turn_m -= disturbance.yaw_m;
  command.tau_speed -= disturbance.surge;
  reallocate(m, command);
  advance(*observers_, disturbance, {command.tau_speed, command.tau_turn_m}, made_of(command),
          motion, sample_time_s_, observed_);
}

}  // namespace awmr
