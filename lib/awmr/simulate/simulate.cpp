#include "awmr/simulate/simulate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/csv.h"

namespace awmr {
namespace {

/// RK4 steps per fastest time constant of the smooth part of the plant: the local error of a mode
/// of time constant T is (h/T)^5/120, so 10 keeps it below 1e-7 of the excursion.
constexpr double kStepsPerTimeConstant = 10.0;

/// The largest speed (m/s, rad/s) below which resistance may be its chord.
constexpr double kChordSpeed = 1e-3;

/// Speed below which resistance is its chord. On the chord the speed decays at alpha
/// w^(beta-1)/inertia; RK4 is stable to rate h < 2.78 and monotone to about 1, so w is where that
/// rate is 1/h:
///   w = (alpha h / inertia)^(1/(1 - beta))   for beta < 1;   no such speed for beta >= 1.
double rest_speed(const Resistance<double>& law, double inertia, double step_s) {
  if (law.beta >= 1.0) return 0.0;
  return std::pow(law.alpha * step_s / inertia, 1.0 / (1.0 - law.beta));
}

double step_for_chord(const Resistance<double>& law, double inertia) {
  if (law.beta >= 1.0) return std::numeric_limits<double>::infinity();
  return inertia / law.alpha * std::pow(kChordSpeed, 1.0 - law.beta);
}

Plant<double> at_rest_resolved(Plant<double> plant, double step_s) {
  plant.surge.rest_speed = rest_speed(plant.surge, plant.mass_norm, step_s);
  plant.yaw.rest_speed = rest_speed(plant.yaw, plant.inertia_norm, step_s);
  return plant;
}

State<double> moved(const State<double>& s, const State<double>& d, double h) {
  return {s.x_m + h * d.x_m,
          s.y_m + h * d.y_m,
          s.psi_rad + h * d.psi_rad,
          s.u_mps + h * d.u_mps,
          s.v_mps + h * d.v_mps,
          s.r_radps + h * d.r_radps,
          s.steering_rad + h * d.steering_rad};
}

/// One step of the classical Runge-Kutta method, commands held.
State<double> rk4_step(const Plant<double>& plant, const State<double>& s,
                       const SideForces<double>& force, double steering_command_rad, double h) {
  const auto rates = [&](const State<double>& at) {
    return state_rates(plant, at, force, steering_command_rad);
  };
  const State<double> k1 = rates(s);
  const State<double> k2 = rates(moved(s, k1, h / 2.0));
  const State<double> k3 = rates(moved(s, k2, h / 2.0));
  const State<double> k4 = rates(moved(s, k3, h));
  State<double> next = moved(s, k1, h / 6.0);
  next = moved(next, k2, h / 3.0);
  next = moved(next, k3, h / 3.0);
  return moved(next, k4, h / 6.0);
}

/// A speed whose square would be below the normal range is rest: no crawl through subnormal
/// numbers.
void settle(double& speed) {
  if (std::abs(speed) < 1e-150) speed = 0.0;
}

double heading_reference(const HeadingSteps& guidance, double t_s) {
  double psi_rad = guidance.steps.front().psi_rad;
  for (const HeadingStep& step : guidance.steps) {
    if (step.t_s <= t_s) psi_rad = step.psi_rad;
  }
  return psi_rad;
}

/// Fills in the row's command from its state.
void command(const Controller<double>& controller, const Scenario& scenario, YawMode mode,
             RunRow& row) {
  Allocation<double> allocation{};
  if (const auto* open = std::get_if<OpenLoop>(&scenario.guidance)) {
    row.tau_speed = open->tau_speed;
    row.tau_turn_m = open->tau_turn_m;
    allocation = allocate(mode, row.tau_speed, row.tau_turn_m, controller.limits);
  } else {
    row.psi_ref_rad = heading_reference(std::get<HeadingSteps>(scenario.guidance), row.t_s);
    row.u_ref_mps = scenario.speed_mps;
    const State<double>& s = row.state;
    const Command<double> c =
        control_step(controller, mode, {s.psi_rad, s.u_mps, s.v_mps, s.r_radps},
                     {row.psi_ref_rad, 0.0, 0.0, row.u_ref_mps, 0.0});
    row.tau_speed = c.tau_speed;
    row.tau_turn_m = c.tau_turn_m;
    allocation = c.allocation;
  }
  row.force = allocation.force;
  row.steering_command_rad = allocation.steering_rad;
}

}  // namespace

/// h <= T/10 for the time constants that do not depend on speed, m'/a_s of sway and T of the servo;
/// and h such that resistance is its chord only below kChordSpeed (rest_speed() solved for h):
///   h <= (inertia/alpha) kChordSpeed^(1 - beta)
int substeps_for(const Plant<double>& plant, double sample_time_s) {
  double step_s = plant.steering_time_constant_s / kStepsPerTimeConstant;
  if (plant.sway_alpha > 0.0) {
    step_s = std::min(step_s, plant.mass_norm / plant.sway_alpha / kStepsPerTimeConstant);
  }
  step_s = std::min(step_s, step_for_chord(plant.surge, plant.mass_norm));
  step_s = std::min(step_s, step_for_chord(plant.yaw, plant.inertia_norm));
  // Room for rounding, so that a sample of exactly n steps takes n.
  return std::max(1, static_cast<int>(std::ceil(sample_time_s / step_s - 1e-9)));
}

Controller<double> make_controller(const Plant<double>& plant, const Vehicle& vehicle,
                                   const Gains<double>& gains, CombinedSplit split) {
  return {.surge = plant.surge,
          .yaw = plant.yaw,
          .mass_norm = plant.mass_norm,
          .inertia_norm = plant.inertia_norm,
          .gains = gains,
          .limits = {.front_axle_m = plant.front_axle_m,
                     .half_track_m = plant.half_track_m,
                     .force_min = vehicle.wheel_force.lo,
                     .force_max = vehicle.wheel_force.hi,
                     .steering_max_rad = plant.steering_max_rad,
                     .split = split}};
}

Run simulate(const Plant<double>& plant, const Controller<double>& controller,
             const Scenario& scenario, YawMode mode, const SimulateOptions& options) {
  Run run;
  run.substeps = options.substeps.value_or(substeps_for(plant, options.sample_time_s));
  const double h = options.sample_time_s / run.substeps;
  const Plant<double> resolved = at_rest_resolved(plant, h);
  // The last sample at or before the duration, with room for rounding.
  const auto samples =
      static_cast<std::size_t>(std::floor(scenario.duration_s / options.sample_time_s + 1e-9));
  run.rows.reserve(samples + 1);
  State<double> state = scenario.initial;
  for (std::size_t k = 0; k <= samples; ++k) {
    RunRow row;
    row.t_s = static_cast<double>(k) * options.sample_time_s;
    row.state = state;
    command(controller, scenario, mode, row);
    run.rows.push_back(row);
    for (int i = 0; i < run.substeps; ++i) {
      state = rk4_step(resolved, state, row.force, row.steering_command_rad, h);
    }
    settle(state.u_mps);
    settle(state.v_mps);
    settle(state.r_radps);
  }
  return run;
}

std::string run_csv(const Run& run) {
  std::string text =
      "t_s,x_m,y_m,psi_rad,u_mps,v_mps,r_radps,force_left,force_right,steering_rad,"
      "steering_cmd_rad,tau_speed,tau_turn,psi_ref_rad,u_ref_mps\n";
  for (const RunRow& row : run.rows) {
    const State<double>& s = row.state;
    const double values[] = {row.t_s,
                             s.x_m,
                             s.y_m,
                             s.psi_rad,
                             s.u_mps,
                             s.v_mps,
                             s.r_radps,
                             row.force.left,
                             row.force.right,
                             s.steering_rad,
                             row.steering_command_rad,
                             row.tau_speed,
                             row.tau_turn_m,
                             row.psi_ref_rad,
                             row.u_ref_mps};
    for (const double value : values) {
      text += format_number(value);
      text += ',';
    }
    text.back() = '\n';
  }
  return text;
}

}  // namespace awmr
