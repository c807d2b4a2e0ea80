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

std::vector<Segment> segments_of(const Run& run) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const bool starts = i == 0 || run.rows[i].psi_ref_rad < run.rows[i - 1].psi_ref_rad ||
                        run.rows[i].psi_ref_rad > run.rows[i - 1].psi_ref_rad;
    if (starts) segments.push_back({i, i});
    segments.back().end = i + 1;
  }
  return segments;
}

double error_deg(const RunRow& row) {
  return degrees(wrap_angle(row.psi_ref_rad - row.state.psi_rad));
}

/// Settling, overshoot, IAE and ITAE over the steps of a heading scenario.
void heading_metrics(const Run& run, Metrics& m) {
  double settling_s = 0.0;
  double overshoot_deg = 0.0;
  double iae = 0.0;
  double itae = 0.0;
  for (const Segment& segment : segments_of(run)) {
    const RunRow& first = run.rows[segment.begin];
    const double step_deg = error_deg(first);
    const double band_deg = std::max(kSettledShare * std::abs(step_deg), kSettledLeastDeg);
    std::size_t settled = segment.begin;
    for (std::size_t i = segment.begin; i < segment.end; ++i) {
      const double e = error_deg(run.rows[i]);
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

void motion_metrics(const Run& run, const Controller<double>& controller, Metrics& m) {
  const auto& limits = controller.limits;
  double variation = 0.0;
  double effort = 0.0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const RunRow& row = run.rows[i];
    const State<double>& s = row.state;
    const double steering = row.steering_command_rad / limits.steering_max_rad;
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
    variation +=
        std::abs(row.steering_command_rad - before.steering_command_rad) / limits.steering_max_rad +
        (std::abs(row.force.left - before.force.left) +
         std::abs(row.force.right - before.force.right)) /
            limits.force_max;
  }
  const double duration_s = run.rows.back().t_s - run.rows.front().t_s;
  m.control_variation = duration_s > 0.0 ? variation / duration_s : 0.0;
  m.control_effort = effort / static_cast<double>(run.rows.size());
}

}  // namespace

Metrics metrics_of(const Run& run, const Scenario& scenario, const Controller<double>& controller) {
  Metrics m;
  motion_metrics(run, controller, m);
  if (std::holds_alternative<HeadingSteps>(scenario.guidance)) {
    heading_metrics(run, m);
    m.speed_drop_mps = speed_drop(run, scenario.speed_mps);
  }
  return m;
}

}  // namespace awmr
