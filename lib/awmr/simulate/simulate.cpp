#include "awmr/simulate/simulate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/control/disturbance_observer.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/pilot.h"
#include "awmr/simulate/sensing.h"

namespace awmr {
namespace {

/// Below this speed a vehicle that was told to stop counts as stopped.
constexpr double kStopped_mps = 1e-3;

/// The laws, and what the scenario adds to them.
class Autopilot {
 public:
  Autopilot(const Controller<double>& controller, const Scenario& scenario, YawMode mode,
            double sample_time_s, const Measurement<double>& start)
      : controller_(controller), scenario_(&scenario), mode_(mode), sample_time_s_(sample_time_s) {
    if (!scenario.control.redistribute) controller_.limits.split = CombinedSplit::kFixedHalf;
    if (const auto& observer = scenario.control.observer) {
      yaw_ = {observer->bandwidth_radps, observer->yaw_max_m};
      surge_ = {observer->bandwidth_radps, observer->surge_max};
      yaw_state_ = start_observer(yaw_, controller_.inertia_norm * start.r_radps);
      surge_state_ = start_observer(surge_, controller_.mass_norm * start.u_mps);
    }
  }

  Command<double> open_loop(const OpenLoop& open) const {
    Command<double> command{open.tau_speed, open.tau_turn_m, 0.0, {}};
    command.allocation = allocate(mode_, command.tau_speed, command.tau_turn_m, controller_.limits);
    return command;
  }

  Command<double> follow(const Measurement<double>& m, const Reference<double>& reference) {
    Command<double> command = control_step(controller_, mode_, m, reference);
    if (scenario_->control.observer) take_off_disturbance(m, command);
    return command;
  }

 private:
  void take_off_disturbance(const Measurement<double>& m, Command<double>& command) {
    const double yaw_d = estimate(yaw_, controller_.inertia_norm * m.r_radps, yaw_state_);
    const double surge_d = estimate(surge_, controller_.mass_norm * m.u_mps, surge_state_);
    command.tau_turn_m -= yaw_d;
    command.tau_speed -= surge_d;
    command.allocation = allocate(mode_, command.tau_speed, command.tau_turn_m, controller_.limits);
    double tau_turn_m = command.tau_turn_m;
    double tau_speed = command.tau_speed;
    if (scenario_->control.observer->anti_windup) {
      const GeneralisedForces<double> tau =
          generalised_forces(controller_.limits.front_axle_m, controller_.limits.half_track_m,
                             command.allocation.force, command.allocation.steering_rad);
      tau_turn_m = tau.tau_steering_m + tau.tau_diff_m;
      tau_speed = tau.tau_speed;
    }
    advance(yaw_, yaw_d, tau_turn_m - controller_.yaw(m.r_radps), sample_time_s_, yaw_state_);
    advance(surge_, surge_d,
            tau_speed + controller_.mass_norm * m.r_radps * m.v_mps - controller_.surge(m.u_mps),
            sample_time_s_, surge_state_);
  }

  Controller<double> controller_;
  const Scenario* scenario_;
  YawMode mode_;
  double sample_time_s_;
  DisturbanceObserver<double> yaw_{}, surge_{};
  ObserverState<double> yaw_state_{}, surge_state_{};
};

/// To the nearest step of the servo and count of the PWM.
void quantise(const Actuators& actuators, double force_max, RunRow& row) {
  if (actuators.steering_quantum_rad > 0.0) {
    row.steering_command_rad =
        actuators.steering_quantum_rad *
        std::round(row.steering_command_rad / actuators.steering_quantum_rad);
  }
  if (actuators.pwm_counts > 0) {
    const double count = force_max / actuators.pwm_counts;
    row.force = {count * std::round(row.force.left / count),
                 count * std::round(row.force.right / count)};
  }
}

double clearance_m(const Scenario& scenario, const State<double>& state) {
  const double vehicle_m = scenario.avoidance ? scenario.avoidance->vehicle_radius_m : 0.0;
  double least_m = std::numeric_limits<double>::max();
  for (const Obstacle<double>& obstacle : scenario.obstacles) {
    least_m = std::min(least_m, distance_m(obstacle.centre_m, {state.x_m, state.y_m}) -
                                    obstacle.radius_m - vehicle_m);
  }
  return least_m;
}

void fill(RunRow& row, const Command<double>& command, double dead_zone) {
  row.tau_speed = command.tau_speed;
  row.tau_turn_m = command.tau_turn_m;
  row.force = {with_dead_zone(command.allocation.force.left, dead_zone),
               with_dead_zone(command.allocation.force.right, dead_zone)};
  row.steering_command_rad = command.allocation.steering_rad;
}

/// What the guidance orders at this row and what the laws make of it. Returns how the run ends
/// here; kDuration: it goes on.
RunEnd follow_guidance(Pilot& pilot, Autopilot& autopilot, const Sensed& sensed, double dead_zone,
                       RunRow& row) {
  const Pilot::Order order = pilot.at(row.t_s, sensed);
  row.course = order.course;
  row.psi_ref_rad = order.reference.psi_rad;
  row.u_ref_mps = order.reference.speed_mps;
  fill(row, autopilot.follow(sensed.motion, order.reference), dead_zone);
  if (order.no_passage && std::abs(row.state.u_mps) < kStopped_mps) return RunEnd::kNoPassage;
  return order.finished ? RunEnd::kFinished : RunEnd::kDuration;
}

}  // namespace

Controller<double> make_controller(const Plant<double>& plant, const Vehicle& vehicle,
                                   const Gains<double>& gains, CombinedSplit split) {
  const double zone = plant.wheel_dead_zone;
  const double backward = vehicle.wheel_force.lo < -zone ? vehicle.wheel_force.lo + zone : 0.0;
  return {.surge = feed_forward(plant.surge),
          .yaw = feed_forward(plant.yaw),
          .mass_norm = plant.mass_norm,
          .inertia_norm = plant.inertia_norm,
          .gains = gains,
          .limits = {.front_axle_m = plant.front_axle_m,
                     .half_track_m = plant.half_track_m,
                     .force_min = zone > 0.0 ? backward : vehicle.wheel_force.lo,
                     .force_max = vehicle.wheel_force.hi - zone,
                     .steering_max_rad = plant.steering_max_rad,
                     .steering_max_tan_half = tan_half(plant.steering_max_rad),
                     .split = split,
                     .dead_zone = zone}};
}

Run simulate(const Plant<double>& plant, const Controller<double>& controller,
             const Scenario& scenario, YawMode mode, const SimulateOptions& options) {
  const double sample_s = options.sample_time_s;
  // The last sample at or before the duration, with room for rounding.
  const auto samples = static_cast<std::size_t>(std::floor(scenario.duration_s / sample_s + 1e-9));
  const double force_max = controller.limits.force_max + controller.limits.dead_zone;
  Physics physics(plant, force_max, scenario, options);
  Sensing sensing(scenario.sensors, sample_s,
                  run_seed(scenario.seed, options.seed, options.sample));
  Sensed sensed = sensing.at(0, physics.state());
  Pilot pilot(scenario, sample_s, sensed);
  Autopilot autopilot(controller, scenario, mode, sample_s, sensed.motion);
  const auto* open = std::get_if<OpenLoop>(&scenario.guidance);

  Run run;
  run.substeps = physics.substeps();
  run.rows.reserve(samples + 1);
  for (std::size_t k = 0; k <= samples && run.end == RunEnd::kDuration; ++k) {
    RunRow& row = run.rows.emplace_back();
    row.t_s = static_cast<double>(k) * sample_s;
    row.state = physics.state();
    if (k > 0) sensed = sensing.at(k, row.state);
    row.measured = sensed.motion;
    row.measured_position_m = sensed.position_m;
    if (!scenario.obstacles.empty()) row.clearance_m = clearance_m(scenario, row.state);
    if (open) {
      fill(row, autopilot.open_loop(*open), controller.limits.dead_zone);
    } else {
      run.end = follow_guidance(pilot, autopilot, sensed, controller.limits.dead_zone, row);
    }
    if (scenario.actuators) quantise(*scenario.actuators, force_max, row);
    row.disturbance = physics.disturb(row.t_s);
    if (run.end == RunEnd::kDuration && k < samples) {
      physics.step(row.t_s, row.force, row.steering_command_rad);
    }
  }
  run.missed_waypoints = pilot.missed();
  return run;
}

Result<Controller<double>> controller_for(const Model& model, const Gains<double>& gains) {
  AWMR_ASSIGN_OR_RETURN(const Plant<double> nominal, model.plant());
  return make_controller(nominal, model.vehicle, gains);
}

Result<Run> simulate(const Model& model, const Gains<double>& gains, const Scenario& scenario,
                     YawMode mode) {
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, plant_for(scenario, model));
  AWMR_ASSIGN_OR_RETURN(const Controller<double> controller, controller_for(model, gains));
  return simulate(plant, controller, scenario, mode,
                  {.sample_time_s = model.vehicle.sample_time_s, .substeps = {}});
}

}  // namespace awmr
