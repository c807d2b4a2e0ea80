#include "awmr/simulate/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "awmr/simulate/metering.h"
#include "awmr/simulate/scenario_guidance.h"

namespace awmr {
namespace {

/// The heading that the guidance commands, before obstacle avoidance and the shaping filter.
double goal_rad(const RunRow& row, const Scenario& scenario) {
  return scenario.shaping || scenario.avoidance ? row.path.psi_goal_rad : row.psi_ref_rad;
}

/// True if the commanded speed is constant in this scenario. Otherwise a speed drop is not defined.
bool has_one_speed(const Scenario& scenario) {
  if (scenario.avoidance || std::holds_alternative<LissajousPath>(scenario.guidance)) return false;
  const auto* waypoints = std::get_if<WaypointPath>(&scenario.guidance);
  const auto* line = std::get_if<LinePath>(&scenario.guidance);
  return !(waypoints && waypoints->slow_down_m) && !(line && line->slow_down_m);
}

}  // namespace

bool is_finite(const MetricsAccumulator<double>& sums) {
  double values[sizeof(MetricsAccumulator<double>) / sizeof(double)];
  std::memcpy(values, &sums, sizeof sums);
  return std::all_of(std::begin(values), std::end(values),
                     [](double value) { return std::isfinite(value); });
}

MetricsTime MeterClock::next(double t_s) {
  const auto* steps = std::get_if<HeadingSteps>(&scenario_->guidance);
  const double goal_rad = steps ? heading_at(*steps, t_s) : 0.0;
  const bool is_first = row_ == 0;
  const MetricsTime time{
      .t_s = t_s,
      .since_last_s = is_first ? 0.0 : t_s - before_s_,
      .is_first = is_first,
      .starts_step = is_first || goal_rad < goal_before_rad_ || goal_rad > goal_before_rad_,
      .is_in_second_half =
          std::holds_alternative<LissajousPath>(scenario_->guidance) && row_ >= (last_ + 1) / 2};
  ++row_;
  before_s_ = t_s;
  goal_before_rad_ = goal_rad;
  return time;
}

MetricsVehicle<double> metered_vehicle(const Controller<double>& controller) {
  const AllocationLimits<double>& limits = controller.limits;
  Resistance<double> yaw = controller.yaw;
  yaw.rest_speed = 0.0;
  return {.front_axle_m = limits.front_axle_m,
          .half_track_m = limits.half_track_m,
          .force_max = limits.force_max,
          .command_max = with_dead_zone(limits.force_max, limits.dead_zone),
          .command_min = with_dead_zone(limits.force_min, limits.dead_zone),
          .steering_max_rad = limits.steering_max_rad,
          .dead_zone = limits.dead_zone,
          .back_emf_s_per_m = limits.back_emf_s_per_m,
          .rear_driven = limits.is_rear_driven ? 1.0 : 0.0,
          .yaw = yaw};
}

std::optional<double> electric_work_j(const Metrics& metrics, const Vehicle& vehicle,
                                      double mass_norm) {
  if (!vehicle.motor_stall_power_w) return std::nullopt;
  return *vehicle.motor_stall_power_w * metrics.energy_electric +
         max_wheel_force_n(vehicle.mass_kg, mass_norm) * metrics.energy_mech;
}

MetricsTask metrics_task(const Scenario& scenario) {
  const auto* timed = std::get_if<LissajousPath>(&scenario.guidance);
  return {.has_headings = std::holds_alternative<HeadingSteps>(scenario.guidance),
          .speed_mps = scenario.speed_mps,
          .tolerance_m = timed ? timed->tolerance_m : 0.0,
          .is_on_tyres = scenario.tyres.has_value()};
}

namespace {

/// Adds the metrics of heading steps, or of a path or route.
void add_course(MetricsAccumulator<double>& sums, const Ending& ending, const Scenario& scenario,
                Metrics& m) {
  if (std::holds_alternative<HeadingSteps>(scenario.guidance)) {
    meter::close_step(sums);
    m.completed = !(sums.never_settled > 0.0);
    if (m.completed) m.settling_time_s = sums.settling_s;
    m.overshoot_deg = sums.overshoot_deg;
    m.heading_iae_degs = sums.iae_degs;
    m.heading_itae_degs2 = sums.itae_degs2;
    return;
  }
  m.cross_track_rms_m = std::sqrt(sums.cross_track_m2 / sums.rows);
  if (std::holds_alternative<LissajousPath>(scenario.guidance)) {
    m.completed = !(sums.strayed > 0.0);
  } else {
    m.completed = ending.end == RunEnd::kFinished && ending.missed_waypoints == 0;
    m.finish_time_s = ending.t_s;
  }
}

}  // namespace

Metrics metrics_of(MetricsAccumulator<double> sums, const Ending& ending,
                   const Scenario& scenario) {
  const bool open = std::holds_alternative<OpenLoop>(scenario.guidance);
  Metrics m;
  m.path_length_m = sums.path_length_m;
  m.sideslip_max_deg = sums.sideslip_max_deg;
  m.yaw_rate_max_degps = sums.yaw_rate_max_degps;
  m.control_variation = ending.t_s > 0.0 ? sums.variation / ending.t_s : 0.0;
  m.control_effort = sums.effort / sums.rows;
  m.energy_mech = sums.energy_mech;
  m.energy_electric = sums.energy_electric;
  m.saturation_s = sums.saturation_s;
  m.steering_travel_deg = sums.steering_travel_deg;
  m.tyre_work = sums.tyre_work;
  m.speed_itae_m_s = sums.speed_itae_m_s;
  if (sums.rows > 1.0) {
    m.steering_rate_rms_degps = std::sqrt(sums.steering_rate2_degps2 / (sums.rows - 1.0));
  }
  if (!open) add_course(sums, ending, scenario, m);
  const bool reached = sums.speed_reached > 0.0 && scenario.speed_mps > 0.0;
  if (!open && has_one_speed(scenario) && reached) {
    m.speed_drop_mps = std::max(0.0, scenario.speed_mps - sums.speed_least_mps);
  }
  if (!scenario.obstacles.empty()) {
    m.clearance_min_m = sums.clearance_min_m;
    m.completed = m.completed && *m.clearance_min_m > 0.0;
  }
  m.completed = m.completed && ending.end != RunEnd::kFailed;
  if (!m.completed) m.finish_time_s.reset();
  return m;
}

Metrics metrics_of(const Run& run, const Scenario& scenario, const Controller<double>& controller) {
  const MetricsVehicle<double> vehicle = metered_vehicle(controller);
  const MetricsTask task = metrics_task(scenario);
  MeterClock clock(scenario, run.rows.size() - 1);
  MetricsAccumulator<double> sums;
  for (const RunRow& row : run.rows) {
    measure({.state = row.state,
             .force = row.force,
             .acting = row.acting,
             .steering_command_rad = row.steering_command_rad,
             .goal_rad = goal_rad(row, scenario),
             .cross_track_m = row.path.cross_track_m,
             .off_target_m = distance_m(row.path.target_m, {row.state.x_m, row.state.y_m}),
             .clearance_m = row.clearance_m,
             .speed_ref_mps = row.u_ref_mps,
             .tyre_power_mps = row.tyre_power_mps},
            vehicle, task, clock.next(row.t_s), sums);
  }
  return metrics_of(sums, {run.end, run.rows.back().t_s, run.missed_waypoints}, scenario);
}

}  // namespace awmr
