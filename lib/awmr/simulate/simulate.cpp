#include "awmr/simulate/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "awmr/core/units.h"
#include "awmr/model/observer_rate.h"
#include "awmr/simulate/one_run.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/pilot.h"
#include "awmr/simulate/sensing.h"
#include "awmr/simulate/straight.h"

namespace awmr {
namespace {

bool is_finite(const RunRow& row) {
  const double numbers[] = {row.state.x_m,
                            row.state.y_m,
                            row.state.psi_rad,
                            row.state.u_mps,
                            row.state.v_mps,
                            row.state.r_radps,
                            row.state.steering_rad,
                            row.force.left,
                            row.force.right,
                            row.steering_command_rad,
                            row.tau_speed,
                            row.tau_turn_m,
                            row.psi_ref_rad,
                            row.u_ref_mps,
                            row.course.psi_goal_rad,
                            row.course.cross_track_m,
                            row.course.target_m.x_m,
                            row.course.target_m.y_m,
                            row.measured.psi_rad,
                            row.measured.u_mps,
                            row.measured.v_mps,
                            row.measured.r_radps,
                            row.measured_position_m.x_m,
                            row.measured_position_m.y_m,
                            row.disturbance.surge,
                            row.disturbance.sway,
                            row.disturbance.yaw_m,
                            row.clearance_m,
                            row.tyre_power_mps};
  return std::all_of(std::begin(numbers), std::end(numbers),
                     [](double number) { return std::isfinite(number); });
}

/// What the guidance orders at this row. Returns how the run ends here; kDuration: it goes on.
RunEnd follow_guidance(Pilot& pilot, const Sensed& sensed, Reference<double>& reference,
                       RunRow& row) {
  const Pilot::Order order = pilot.at(row.t_s, sensed);
  reference = order.reference;
  row.course = order.course;
  row.psi_ref_rad = order.reference.psi_rad;
  row.u_ref_mps = order.reference.speed_mps;
  if (order.no_passage && std::abs(row.state.u_mps) < kStopped_mps) return RunEnd::kNoPassage;
  return order.finished ? RunEnd::kFinished : RunEnd::kDuration;
}

/// What is commanded at this row, as far as the actuators can. Returns how the run ends here.
RunEnd command(const Scenario& scenario, double force_most, const RunController<double>& controller,
               const Sensed& sensed, Pilot& pilot, RunControllerState<double>& state, RunRow& row) {
  RunEnd end = RunEnd::kDuration;
  Reference<double> reference{};
  if (!controller.is_open_loop) end = follow_guidance(pilot, sensed, reference, row);
  const RunCommand<double> made = command_sample(controller, sensed.motion, reference, state);
  row.tau_speed = made.tau_speed;
  row.tau_turn_m = made.tau_turn_m;
  row.force = made.force;
  row.steering_command_rad = made.steering_rad;
  if (scenario.actuators) {
    quantise(*scenario.actuators, force_most, row.force, row.steering_command_rad);
  }
  return end;
}

}  // namespace

Controller<double> controller_in(const Scenario& scenario, Controller<double> controller) {
  controller.limits.form = scenario.control.allocation.value_or(controller.limits.form);
  if (scenario.control.split != CombinedSplit::kRedistribute) {
    controller.limits.split = scenario.control.split;
  }
  return controller;
}

namespace {

/// The scenario's observer, or else the one of the gains; bandwidth 0 where there is none. An LQI takes
/// no gains, and so not their observer.
Observers<double> observers_in(const Scenario& scenario, const Gains<double>& gains) {
  // A held thrust leaves a surge observer nothing to act on.
  const auto surge_limit = [&](double limit) { return scenario.held_tau_speed() ? 0.0 : limit; };
  if (const auto& own = scenario.control.observer) {
    return {{own->bandwidth_radps, own->yaw_max_m},
            {own->bandwidth_radps, surge_limit(own->surge_max)},
            own->anti_windup};
  }
  const ObserverGains<double> tuned =
      scenario.control.lqi ? ObserverGains<double>{} : gains.observer;
  return {{tuned.bandwidth_radps, tuned.yaw_max_m},
          {tuned.bandwidth_radps, surge_limit(tuned.surge_max)},
          true};
}

}  // namespace

RunController<double> run_controller(const Scenario& scenario, const Controller<double>& controller,
                                     YawMode mode, double sample_time_s) {
  const Controller<double> own = controller_in(scenario, controller);
  const auto held = scenario.held_tau_speed();
  const auto* const open = std::get_if<OpenLoop>(&scenario.guidance);
  RunController<double> c{.laws = prepared(own),
                          .geometry = geometry_of(own.limits),
                          .split = yaw_split<double>(mode, own.limits.split),
                          .dead_zone = own.limits.dead_zone,
                          .back_emf_s_per_m = own.limits.back_emf_s_per_m,
                          .sample_time_s = sample_time_s,
                          .is_open_loop = open != nullptr,
                          .holds_tau_speed = held.has_value(),
                          .is_lqi = scenario.control.lqi.has_value() && !open,
                          .is_observed = false,
                          .tau_speed = open ? open->tau_speed : held.value_or(0.0),
                          .tau_turn_m = open ? open->tau_turn_m : 0.0,
                          .lqi = {},
                          .observers = observers_in(scenario, own.gains)};
  c.is_observed = c.observers.yaw.bandwidth_radps > 0.0 && !open;
  if (c.is_lqi) c.lqi = lqi_gains(*scenario.control.lqi, own.inertia_norm);
  return c;
}

double largest_force(const Controller<double>& controller) {
  return controller.limits.force_max + controller.limits.dead_zone;
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

std::size_t samples_in(double duration_s, double sample_time_s) {
  return static_cast<std::size_t>(std::floor(duration_s / sample_time_s + 1e-9));
}

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
                     .form = vehicle.allocation,
                     .dead_zone = zone,
                     .back_emf_s_per_m = plant.back_emf_s_per_m,
                     .is_rear_driven = plant.rear_driven > 0.0}};
}

Status check_work(const Plant<double>& plant, const std::string& model_file,
                  const Scenario& scenario, double sample_time_s) {
  const double rows = scenario.duration_s / sample_time_s + 1.0;
  if (!(rows <= kMostRows)) {
    return input_error(
        fmt::format("scenario '{}':/duration_s", scenario.name),
        fmt::format("{:g} s at a sample time of {:g} s are {:.3g} rows, more than the {:g} that a "
                    "run may have: give at most {:g} s",
                    scenario.duration_s, sample_time_s, rows, kMostRows,
                    (kMostRows - 1.0) * sample_time_s));
  }
  const double steps = steps_of_run(plant, scenario, sample_time_s);
  if (!(steps <= kMostSteps)) {
    const StepLimit limit = step_limit(plant, scenario.tyres.has_value());
    const ParameterInfo& parameter = info(limit.parameter);
    return input_error(
        model_file + ":" + std::string(parameter.pointer),
        fmt::format("its time constant asks for RK4 steps of {:.3g} s, {:.3g} of them in {:g} s "
                    "(scenario '{}'), more than the {:g} that a run may take: check {} and what it "
                    "is divided by, or give a shorter duration_s",
                    limit.step_s, steps, scenario.duration_s, scenario.name, kMostSteps,
                    parameter.name));
  }
  return {};
}

Status failure_of(const Run& run, const Scenario& scenario) {
  if (run.end != RunEnd::kFailed) return {};
  const RunRow& last = run.rows.back();
  return input_error(
      fmt::format("scenario '{}'", scenario.name),
      fmt::format("the simulation cannot go on after {:g} s, at u {:.4g} m/s, v {:.4g} m/s, r "
                  "{:.4g} deg/s: resistance is too stiff there for any step, or a number is no "
                  "longer finite; check the initial speeds, the disturbances, {}and the model's "
                  "exponents",
                  last.t_s, last.state.u_mps, last.state.v_mps, degrees(last.state.r_radps),
                  scenario.tyres ? "the tyres' cornering stiffness and rest speed, " : ""));
}

Run simulate(const Plant<double>& plant, const Controller<double>& controller,
             const Scenario& scenario, YawMode mode, const SimulateOptions& options) {
  const double sample_s = options.sample_time_s;
  const bool too_much = !check_work(plant, "", scenario, sample_s) && !options.substeps.has_value();
  const auto samples = too_much ? std::size_t{0} : samples_in(scenario.duration_s, sample_s);
  Physics physics(plant, largest_force(controller), scenario, options);
  Sensing sensing(scenario.sensors, sample_s,
                  run_seed(scenario.seed, options.seed, options.sample));
  Sensed sensed = sensing.at(0, physics.state());
  Pilot pilot(scenario, sample_s, sensed);
  const RunController<double> laws = run_controller(scenario, controller, mode, sample_s);
  RunControllerState<double> state = start_controller(laws, sensed.motion);

  Run run;
  run.substeps = physics.substeps();
  run.rows.reserve(samples + 1);
  for (std::size_t k = 0; k <= samples && run.end == RunEnd::kDuration; ++k) {
    RunRow& row = run.rows.emplace_back();
    row.t_s = static_cast<double>(k) * sample_s;
    row.state = physics.state();
    row.acting = physics.acting();
    if (k > 0) sensed = sensing.at(k, row.state);
    row.measured = sensed.motion;
    row.measured_position_m = sensed.position_m;
    if (!scenario.obstacles.empty()) row.clearance_m = clearance_m(scenario, row.state);
    run.end = command(scenario, largest_force(controller), laws, sensed, pilot, state, row);
    row.disturbance = physics.disturb(row.t_s);
    row.tyre_power_mps = physics.tyre_power_mps(row.force);
    if (!is_finite(row)) {
      if (k > 0) run.rows.pop_back();
      run.end = RunEnd::kFailed;
    }
    if (run.end == RunEnd::kDuration && k < samples) {
      physics.step(row.t_s, row.force, row.steering_command_rad);
      if (!physics.resolved()) run.end = RunEnd::kFailed;
    }
  }
  if (too_much) run.end = RunEnd::kFailed;
  run.missed_waypoints = pilot.missed();
  return run;
}

Result<Controller<double>> controller_for(const Model& model, const Gains<double>& gains) {
  AWMR_RETURN_IF_ERROR(check_observer_rate(gains.observer.bandwidth_radps,
                                           model.vehicle.sample_time_s,
                                           "gains:/observer/bandwidth_radps"));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> nominal, model.plant(model.simulated_motion()));
  return make_controller(nominal, model.vehicle, gains);
}

Result<Run> simulate(const Model& model, const Gains<double>& gains, const Scenario& scenario,
                     YawMode mode) {
  AWMR_RETURN_IF_ERROR(check_mode(model.vehicle, mode));
  const Motion motion = model.simulated_motion();
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, plant_for(scenario, model, motion));
  AWMR_ASSIGN_OR_RETURN(const Controller<double> controller, controller_for(model, gains));
  Run run = simulate(plant, controller, scenario, mode,
                     {.sample_time_s = model.vehicle.sample_time_s, .substeps = {}});
  if (motion == Motion::kStraight) AWMR_RETURN_IF_ERROR(check_straight(run, scenario, model));
  AWMR_RETURN_IF_ERROR(failure_of(run, scenario));
  return run;
}

}  // namespace awmr
