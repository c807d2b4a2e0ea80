#include "awmr/simulate/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/units.h"
#include "awmr/model/observer_rate.h"
#include "awmr/simulate/closed_loop.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/physics.h"

namespace awmr {

Controller<double> controller_in(const Scenario& scenario, Controller<double> controller) {
  controller.limits.form = scenario.control.allocation.value_or(controller.limits.form);
  if (scenario.control.split != CombinedSplit::kRedistribute) {
    controller.limits.split = scenario.control.split;
  }
  return controller;
}

namespace {

/// Returns the disturbance observer of the scenario, or else the observer of the gains. Bandwidth
/// 0: none. The LQI does not use the observer of the gains, which was tuned for the sliding mode.
ObserverGains<double> observer_in(const Scenario& scenario, const Gains<double>& gains) {
  ObserverGains<double> observer = scenario.control.lqi ? ObserverGains<double>{} : gains.observer;
  if (scenario.control.observer) observer = *scenario.control.observer;
  // A constant thrust replaces the speed law, so a surge observer has no effect.
  if (scenario.held_tau_speed()) observer.surge_max = 0.0;
  return observer;
}

/// True if nothing in this row turns the vehicle or moves it sideways, except rounding errors, for
/// example of sin(pi) or atan2. These are larger than usual: the unknown resistances in yaw and
/// sway are simulated as 0, so nothing damps them.
bool is_straight(const RunRow& row) {
  constexpr double kRounding = 1e-9;  // m/s, rad/s, rad, m
  const double turning[] = {row.state.v_mps,        row.state.r_radps,
                            row.state.steering_rad, row.steering_command_rad,
                            row.tau_turn_m,         row.force.right - row.force.left};
  return std::all_of(std::begin(turning), std::end(turning),
                     [](double number) { return std::abs(number) <= kRounding; });
}

/// Checks that the vehicle drives straight, for a model that only has parameters for straight
/// motion. Errors (input): the run turns, or moves sideways. The message has the time and the
/// missing parameters.
Status check_straight(const Run& run, const Scenario& scenario, const Model& model) {
  const auto turned = std::find_if_not(run.rows.begin(), run.rows.end(), is_straight);
  if (turned == run.rows.end()) return {};
  Error error = model.plant(Motion::kPlanar).error();
  error.faults.insert(
      error.faults.begin(),
      Fault{ErrorCode::kUnsupported, fmt::format("scenario '{}'", scenario.name),
            fmt::format("the run turns at {:g} s, but the model only has parameters for straight "
                        "motion; give a scenario without turns, or record the trials named below",
                        turned->t_s)});
  return tl::unexpected(std::move(error));
}

}  // namespace

ControllerSetup controller_setup(const Scenario& scenario, const Controller<double>& controller,
                                 double sample_time_s) {
  const AllocationLimits<double> limits = controller_in(scenario, controller).limits;
  const bool is_open_loop = std::holds_alternative<OpenLoop>(scenario.guidance);
  return {.geometry = geometry_of(limits),
          .split = limits.split,
          .is_open_loop = is_open_loop,
          .holds_tau_speed = scenario.held_tau_speed().has_value(),
          .is_lqi = scenario.control.lqi.has_value() && !is_open_loop,
          .anti_windup = scenario.control.anti_windup,
          .sample_time_s = sample_time_s};
}

RunController<double> run_controller(const Scenario& scenario, const Controller<double>& controller,
                                     YawMode mode) {
  const auto held = scenario.held_tau_speed();
  const auto* const open = std::get_if<OpenLoop>(&scenario.guidance);
  const ObserverGains<double> observer = observer_in(scenario, controller.gains);
  const double share = steering_share<double>(mode);
  Controller<double> in_mode = controller;
  in_mode.yaw = feed_forward(controller.yaw, controller.gains.friction_width_at(share));
  RunController<double> c{.laws = prepared(in_mode),
                          .steering_share = share,
                          .dead_zone = controller.limits.dead_zone,
                          .back_emf_s_per_m = controller.limits.back_emf_s_per_m,
                          .tau_speed = open ? open->tau_speed : held.value_or(0.0),
                          .tau_turn_m = open ? open->tau_turn_m : 0.0,
                          .lqi = {},
                          .yaw_observer = {observer.bandwidth_radps, observer.yaw_max_m},
                          .surge_observer = {observer.bandwidth_radps, observer.surge_max}};
  if (scenario.control.lqi && !open) {
    c.lqi = lqi_gains(*scenario.control.lqi, controller.inertia_norm);
  }
  return c;
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
  const Interval force = forces_beyond_dead_zone(vehicle.wheel_force, zone);
  return {.surge = feed_forward(plant.surge),
          .yaw = feed_forward(plant.yaw, gains.heading.friction_width_radps),
          .mass_norm = plant.mass_norm,
          .inertia_norm = plant.inertia_norm,
          .gains = gains,
          .limits = {.front_axle_m = plant.front_axle_m,
                     .half_track_m = plant.half_track_m,
                     .force_min = force.lo,
                     .force_max = force.hi,
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
  if (!(rows <= kMaxRows)) {
    return input_error(
        ErrorCode::kTooLarge, fmt::format("scenario '{}':/duration_s", scenario.name),
        fmt::format("a run of {:g} s at a sample time of {:g} s has {:.3g} rows, but at most {:g} "
                    "are possible; give a duration_s of at most {:g}",
                    scenario.duration_s, sample_time_s, rows, kMaxRows,
                    (kMaxRows - 1.0) * sample_time_s));
  }
  const double steps = steps_of_run(plant, scenario, sample_time_s);
  if (!(steps <= kMaxSteps)) {
    const StepLimit limit = step_limit(plant, scenario.tyres.has_value());
    const ParameterInfo& parameter = info(limit.parameter);
    return input_error(
        ErrorCode::kTooLarge, model_file + ":" + std::string(parameter.pointer),
        fmt::format(
            "the time constant that follows from this parameter requires RK4 steps of {:.3g} s, "
            "that is, {:.3g} steps for the {:g} s of scenario '{}'; a run has at most {:g} steps. "
            "Check {} and the mass or inertia, or give a shorter duration_s",
            limit.step_s, steps, scenario.duration_s, scenario.name, kMaxSteps, parameter.name));
  }
  return {};
}

Status failure_of(const Run& run, const Scenario& scenario) {
  if (run.end != RunEnd::kFailed) return {};
  const RunRow& last = run.rows.back();
  return input_error(
      ErrorCode::kDiverges, fmt::format("scenario '{}'", scenario.name),
      fmt::format("the simulation cannot continue after {:g} s, at u {:.4g} m/s, v {:.4g} m/s, r "
                  "{:.4g} deg/s: no integration step is short enough for the resistance at these "
                  "speeds, or a number is not finite; check the initial speeds, the disturbances, "
                  "{}and the exponents in the model",
                  last.t_s, last.state.u_mps, last.state.v_mps, degrees(last.state.r_radps),
                  scenario.tyres ? "the tyres' cornering stiffness and rest speed, " : ""));
}

Run simulate(const Plant<double>& plant, const Controller<double>& controller,
             const Scenario& scenario, YawMode mode, const SimulateOptions& options) {
  const double sample_s = options.sample_time_s;
  const bool too_much = !check_work(plant, "", scenario, sample_s) && !options.substeps.has_value();
  const auto samples = too_much ? std::size_t{0} : samples_in(scenario.duration_s, sample_s);
  const BatchRun only{plant, controller, mode, options.seed, options.sample, options.noise};
  ClosedLoop<double> loop(std::span(&only, 1), scenario, kOneRunSteps,
                          {.sample_time_s = sample_s,
                           .samples = samples,
                           .substeps = options.substeps,
                           .keeps_rows = true});
  loop.drive();
  Run run = loop.take_run(0);
  if (too_much) run.end = RunEnd::kFailed;
  return run;
}

Result<Controller<double>> controller_for(const Model& model, const Gains<double>& gains) {
  AWMR_RETURN_IF_ERROR(check_observer_rate(gains.observer.bandwidth_radps,
                                           model.vehicle.sample_time_s,
                                           "gains:/observer/bandwidth_radps"));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> nominal, model.plant(model.simulated_motion()));
  return make_controller(nominal, model.vehicle, gains);
}

Result<Run> simulate(const Model& model, const Gains<double>& gains, const Scenario& as_given,
                     YawMode mode) {
  AWMR_RETURN_IF_ERROR(check_mode(model.vehicle, mode));
  const Scenario scenario = equipped(model.vehicle, as_given);
  const Motion motion = model.simulated_motion();
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, plant_for(scenario, model, motion));
  AWMR_ASSIGN_OR_RETURN(const Controller<double> controller, controller_for(model, gains));
  Run run =
      simulate(plant, controller, scenario, mode, {.sample_time_s = model.vehicle.sample_time_s});
  if (motion == Motion::kStraight) AWMR_RETURN_IF_ERROR(check_straight(run, scenario, model));
  AWMR_RETURN_IF_ERROR(failure_of(run, scenario));
  return run;
}

}  // namespace awmr
