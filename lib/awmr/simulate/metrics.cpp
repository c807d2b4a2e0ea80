#include "awmr/simulate/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "awmr/core/units.h"

namespace awmr {
namespace {

constexpr double kReachedShare = 0.001;   ///< of the commanded speed
constexpr double kSettledShare = 0.02;    ///< of the step's size
constexpr double kSettledLeastDeg = 0.5;  ///< band of the smallest steps
constexpr double kMovingMps = 0.05;       ///< below it the sideslip angle has no meaning

/// The rows of one commanded heading.
struct Segment {
  std::size_t begin;
  std::size_t end;  ///< one past the last
};

/// The commanded heading, before what the scenario does to it on the way to the law.
double goal_rad(const RunRow& row, const Scenario& scenario) {
  return scenario.shaping || scenario.avoidance ? row.course.psi_goal_rad : row.psi_ref_rad;
}

std::vector<Segment> segments_of(const Run& run, const Scenario& scenario) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double goal = goal_rad(run.rows[i], scenario);
    const double before = i == 0 ? goal : goal_rad(run.rows[i - 1], scenario);
    const bool starts = i == 0 || goal < before || goal > before;
    if (starts) segments.push_back({i, i});
    segments.back().end = i + 1;
  }
  return segments;
}

double error_deg(const RunRow& row, const Scenario& scenario) {
  return degrees(wrap_angle(goal_rad(row, scenario) - row.state.psi_rad));
}

/// Settling, overshoot, IAE and ITAE over the steps of a heading scenario.
void heading_metrics(const Run& run, const Scenario& scenario, Metrics& m) {
  double settling_s = 0.0;
  double overshoot_deg = 0.0;
  double iae = 0.0;
  double itae = 0.0;
  for (const Segment& segment : segments_of(run, scenario)) {
    const RunRow& first = run.rows[segment.begin];
    const double step_deg = error_deg(first, scenario);
    const double band_deg = std::max(kSettledShare * std::abs(step_deg), kSettledLeastDeg);
    std::size_t settled = segment.begin;
    for (std::size_t i = segment.begin; i < segment.end; ++i) {
      const double e = error_deg(run.rows[i], scenario);
      if (std::abs(e) > band_deg) settled = i + 1;
      overshoot_deg = std::max(overshoot_deg, step_deg > 0.0 ? -e : e);
      if (i + 1 == run.rows.size()) break;
      const double dt = run.rows[i + 1].t_s - run.rows[i].t_s;
      iae += std::abs(e) * dt;
      itae += (run.rows[i].t_s - first.t_s) * std::abs(e) * dt;
    }
    if (settled >= segment.end) {
      m.completed = false;
    } else {
      settling_s = std::max(settling_s, run.rows[settled].t_s - first.t_s);
    }
  }
  if (m.completed) m.settling_time_s = settling_s;
  m.overshoot_deg = overshoot_deg;
  m.heading_iae_degs = iae;
  m.heading_itae_degs2 = itae;
}

/// Commanded speed minus the least after it was first reached within 0.1 %.
std::optional<double> speed_drop(const Run& run, double speed_mps) {
  std::optional<double> least;
  for (const RunRow& row : run.rows) {
    const bool reached = row.state.u_mps >= (1.0 - kReachedShare) * speed_mps;
    if (reached || least) least = std::min(least.value_or(row.state.u_mps), row.state.u_mps);
  }
  if (!least || !(speed_mps > 0.0)) return std::nullopt;
  return std::max(0.0, speed_mps - *least);
}

/// A commanded angle over the largest; 0 where the vehicle has no steering.
double share_of_stop(double steering_rad, double steering_max_rad) {
  return steering_max_rad > 0.0 ? steering_rad / steering_max_rad : 0.0;
}

void motion_metrics(const Run& run, const Controller<double>& controller, Metrics& m) {
  const auto& limits = controller.limits;
  double variation = 0.0;
  double effort = 0.0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const RunRow& row = run.rows[i];
    const State<double>& s = row.state;
    const double steering = share_of_stop(row.steering_command_rad, limits.steering_max_rad);
    effort +=
        row.force.left * row.force.left + row.force.right * row.force.right + steering * steering;
    if (std::hypot(s.u_mps, s.v_mps) > kMovingMps) {
      m.sideslip_max_deg =
          std::max(m.sideslip_max_deg, std::abs(degrees(std::atan2(s.v_mps, s.u_mps))));
    }
    m.yaw_rate_max_degps = std::max(m.yaw_rate_max_degps, std::abs(degrees(s.r_radps)));
    if (i == 0) continue;
    const RunRow& before = run.rows[i - 1];
    m.path_length_m += std::hypot(s.x_m - before.state.x_m, s.y_m - before.state.y_m);
    variation += share_of_stop(std::abs(row.steering_command_rad - before.steering_command_rad),
                               limits.steering_max_rad) +
                 (std::abs(row.force.left - before.force.left) +
                  std::abs(row.force.right - before.force.right)) /
                     limits.force_max;
  }
  const double duration_s = run.rows.back().t_s - run.rows.front().t_s;
  m.control_variation = duration_s > 0.0 ? variation / duration_s : 0.0;
  m.control_effort = effort / static_cast<double>(run.rows.size());
}

/// Power that the four wheels put into the vehicle, over F_max, m/s. The rear axle rolls ahead; the
/// front wheels roll along d_r:
///   w_rear  = u -+ d r
///   w_front = (u -+ d r) cos d_r + (v + l_f r) sin d_r            upper sign: left, lower: right
double driving_power(const RunRow& row, const AllocationLimits<double>& limits) {
  const State<double>& s = row.state;
  const double across_mps = (s.v_mps + limits.front_axle_m * s.r_radps) * std::sin(s.steering_rad);
  const auto of_side = [&](double force, double side) {
    const double rear_mps = s.u_mps - side * limits.half_track_m * s.r_radps;
    const double front_mps = rear_mps * std::cos(s.steering_rad) + across_mps;
    return std::max(0.0, force * rear_mps) + std::max(0.0, force * front_mps);
  };
  return of_side(row.force.left, 1.0) + of_side(row.force.right, -1.0);
}

bool at_a_limit(const RunRow& row, const AllocationLimits<double>& limits) {
  const auto forced = [&](double force) {
    return force >= with_dead_zone(limits.force_max, limits.dead_zone) ||
           force <= with_dead_zone(limits.force_min, limits.dead_zone);
  };
  return forced(row.force.left) || forced(row.force.right) ||
         (limits.steering_max_rad > 0.0 &&
          std::abs(row.steering_command_rad) >= limits.steering_max_rad);
}

/// Energy, wear and limits; commands are held over each sample.
void work_metrics(const Run& run, const Controller<double>& controller, Metrics& m) {
  const auto& limits = controller.limits;
  for (std::size_t i = 0; i + 1 < run.rows.size(); ++i) {
    const RunRow& row = run.rows[i];
    const RunRow& next = run.rows[i + 1];
    const double dt_s = next.t_s - row.t_s;
    m.energy_mech += dt_s * driving_power(row, limits);
    m.energy_electric +=
        dt_s * 2.0 * (row.force.left * row.force.left + row.force.right * row.force.right);
    m.tyre_work += dt_s * controller.yaw(row.state.r_radps) * row.state.r_radps;
    if (at_a_limit(row, limits)) m.saturation_s += dt_s;
    m.steering_travel_deg += std::abs(degrees(next.state.steering_rad - row.state.steering_rad));
  }
}

/// How far from the leg, line or path, root mean square over the rows from `begin` on.
double cross_track_rms_m(const Run& run, std::size_t begin) {
  double sum = 0.0;
  for (std::size_t i = begin; i < run.rows.size(); ++i) {
    sum += run.rows[i].course.cross_track_m * run.rows[i].course.cross_track_m;
  }
  return std::sqrt(sum / static_cast<double>(run.rows.size() - begin));
}

/// Courses that end are completed when they have; a timed one when the vehicle is no further from
/// the path's point than its tolerance in the second half of the run.
void course_metrics(const Run& run, const Scenario& scenario, Metrics& m) {
  m.cross_track_rms_m = cross_track_rms_m(run, 0);
  if (const auto* timed = std::get_if<LissajousCourse>(&scenario.guidance)) {
    for (std::size_t i = run.rows.size() / 2; i < run.rows.size(); ++i) {
      const RunRow& row = run.rows[i];
      const double off_m = distance_m(row.course.target_m, {row.state.x_m, row.state.y_m});
      m.completed = m.completed && off_m <= timed->tolerance_m;
    }
    return;
  }
  m.completed = run.end == RunEnd::kFinished && run.missed_waypoints == 0;
  if (m.completed) m.finish_time_s = run.rows.back().t_s;
}

/// Whether the guidance asks for one speed all the time, which a drop can be held against.
bool asks_for_one_speed(const Scenario& scenario) {
  if (scenario.avoidance || std::holds_alternative<LissajousCourse>(scenario.guidance))
    return false;
  const auto* waypoints = std::get_if<WaypointCourse>(&scenario.guidance);
  const auto* line = std::get_if<LineCourse>(&scenario.guidance);
  return !(waypoints && waypoints->slow_down_m) && !(line && line->slow_down_m);
}

}  // namespace

Metrics metrics_of(const Run& run, const Scenario& scenario, const Controller<double>& controller) {
  Metrics m;
  motion_metrics(run, controller, m);
  work_metrics(run, controller, m);
  const bool open = std::holds_alternative<OpenLoop>(scenario.guidance);
  if (std::holds_alternative<HeadingSteps>(scenario.guidance)) {
    heading_metrics(run, scenario, m);
  } else if (!open) {
    course_metrics(run, scenario, m);
  }
  if (!open && asks_for_one_speed(scenario)) m.speed_drop_mps = speed_drop(run, scenario.speed_mps);
  if (!scenario.obstacles.empty()) {
    m.clearance_min_m = run.rows.front().clearance_m;
    for (const RunRow& row : run.rows) {
      m.clearance_min_m = std::min(*m.clearance_min_m, row.clearance_m);
    }
    m.completed = m.completed && *m.clearance_min_m > 0.0;
  }
  m.completed = m.completed && run.end != RunEnd::kFailed;
  return m;
}

}  // namespace awmr
