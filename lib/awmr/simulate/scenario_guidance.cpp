#include "awmr/simulate/scenario_guidance.h"

#include <algorithm>
#include <cmath>

#include "awmr/simulate/passage.h"

namespace awmr {
namespace {

/// Distance of the point p from the line through a and b, m, positive to the left of the direction
/// from a to b; if a and b coincide, the distance of p from a.
double from_line_m(const Position<double>& a, const Position<double>& b,
                   const Position<double>& p) {
  const double length_m = distance_m(a, b);
  if (!(length_m > 0.0)) return distance_m(a, p);
  return ((b.x_m - a.x_m) * (p.y_m - a.y_m) - (b.y_m - a.y_m) * (p.x_m - a.x_m)) / length_m;
}

}  // namespace

double heading_at(const HeadingSteps& guidance, double t_s) {
  double psi_rad = guidance.steps.front().psi_rad;
  for (const HeadingStep& step : guidance.steps) {
    if (step.t_s <= t_s) psi_rad = step.psi_rad;
  }
  return psi_rad;
}

ScenarioGuidance::ScenarioGuidance(const Scenario& scenario, double sample_time_s)
    : scenario_(&scenario), sample_time_s_(sample_time_s), sectors_(scenario.obstacles.size()) {
  std::visit([&](const auto& path) { set_up(path); }, scenario.guidance);
  if (scenario.avoidance) {
    static_cast<Avoider<double>&>(laws_) = {*scenario.avoidance,
                                            scenario.obstacles.data(),
                                            sectors_.data(),
                                            static_cast<int>(scenario.obstacles.size()),
                                            {}};
  }
  if (scenario.shaping) {
    static_cast<Shaper<double>&>(laws_) = {*scenario.shaping, sample_time_s, {}, true, false};
  }
}

void ScenarioGuidance::set_up(const WaypointPath& path) {
  laws_.waypoints = {path.points_m.data(), static_cast<int>(path.points_m.size()),
                     path.acceptance_m, path.skip_passed};
  laws_.acceptance_m2 = path.acceptance_m * path.acceptance_m;
  laws_.distance_m = path.slow_down_m.value_or(0.0);
}

void ScenarioGuidance::set_up(const LinePath& path) {
  AnyLineFollower<double>& part = laws_;
  part.line = {path.points_m.data(), static_cast<int>(path.points_m.size()), path.corner_m,
               path.law};
  part.sample_time_s = sample_time_s_;
  laws_.distance_m = path.slow_down_m.value_or(0.0);
}

void ScenarioGuidance::set_up(const LissajousPath& path) {
  PathFollower<double, double>& part = laws_;
  part.path = path.path;
  part.gain_per_s = path.closed_loop ? path.position_gain_per_s : 0.0;
  part.is_on = true;
}

GuidanceOutput ScenarioGuidance::step(double t_s, const Sensed& sensed) {
  const Pose pose{sensed.position_m, sensed.motion, t_s};
  GuidanceOutput output;
  output.reference.speed_mps = scenario_->speed_mps;
  if (const auto* steps = std::get_if<HeadingSteps>(&scenario_->guidance)) {
    output.reference.psi_rad = heading_at(*steps, t_s);
  }
  const GuidanceTarget<double> target = guide_by_route(laws_, pose, output.reference);
  output.finished = target.arrived;
  std::visit([&](const auto& path) { describe(path, pose, output); }, scenario_->guidance);
  output.path.psi_goal_rad = output.reference.psi_rad;
  if (output.finished || output.no_passage) output.reference.speed_mps = 0.0;
  if (!output.no_passage) {
    steer_around_obstacles(part_of<Avoider<double>>(laws_), pose, target, output.reference);
  }
  shape_heading(part_of<Shaper<double>>(laws_), pose, output.reference);
  return output;
}

/// True if the obstacles leave a way from `from` to `to`, the target of the leg with the index
/// `leg`. Checked once per leg, at the vehicle's position at its start; later calls return the
/// stored result. Always true without avoidance.
bool ScenarioGuidance::way_is_free(const Position<double>& from, const Position<double>& to,
                                   int leg) {
  if (!scenario_->avoidance) return true;
  if (leg_checked_ != leg) {
    const Avoidance<double>& a = *scenario_->avoidance;
    passage_ = passage_exists(scenario_->obstacles, a.vehicle_radius_m + a.clearance_m, from, to);
    leg_checked_ = leg;
  }
  return passage_;
}

void ScenarioGuidance::describe(const WaypointPath& path, const Pose& pose,
                                GuidanceOutput& output) {
  const int count = static_cast<int>(path.points_m.size());
  output.path.leg = std::min(laws_.progress.next, count - 1);
  output.path.target_m = path.points_m[static_cast<std::size_t>(output.path.leg)];
  if (output.finished) return;
  output.path.cross_track_m =
      from_line_m(laws_.progress.leg_start_m, output.path.target_m, pose.position_m);
  output.no_passage = !way_is_free(pose.position_m, output.path.target_m, laws_.progress.next);
}

void ScenarioGuidance::describe(const LinePath& path, const Pose& pose, GuidanceOutput& output) {
  const int count = static_cast<int>(path.points_m.size());
  const AnyLineFollower<double>& part = laws_;
  output.path.leg = std::min(part.progress.segment, count - 2);
  output.path.target_m = path.points_m[static_cast<std::size_t>(output.path.leg) + 1];
  output.path.cross_track_m = part.guided.cross_track_m;
  output.no_passage = !output.finished && !way_is_free(pose.position_m, path.points_m.back(), 0);
}

void ScenarioGuidance::describe(const LissajousPath& path, const Pose& pose,
                                GuidanceOutput& output) {
  const PathPoint<double> point = path.path.at(elapsed_s(laws_.start, pose.now));
  output.path.target_m = point.position_m;
  const Position<double> ahead{point.position_m.x_m + point.vx_mps,
                               point.position_m.y_m + point.vy_mps};
  output.path.cross_track_m = from_line_m(point.position_m, ahead, pose.position_m);
}

}  // namespace awmr
