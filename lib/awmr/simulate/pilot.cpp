#include "awmr/simulate/pilot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/simulate/passage.h"

namespace awmr {
namespace {

constexpr double kNoTarget_m = std::numeric_limits<double>::infinity();

double share_left(const std::optional<double>& slow_down_m, double to_go_m) {
  return slow_down_m ? arrival_share(*slow_down_m, to_go_m) : 1.0;
}

/// Distance of p from the line through a and b, left of its direction positive; from a where the
/// two coincide.
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

Pilot::Pilot(const Scenario& scenario, double sample_time_s, const Sensed& start)
    : scenario_(&scenario),
      sample_time_s_(sample_time_s),
      waypoints_(start_waypoints(start.position_m, start.motion.psi_rad)),
      line_{start_polyline(start.motion.psi_rad)},
      sectors_(scenario.obstacles.size()),
      shaped_(start_shaping(start.motion.psi_rad)),
      held_rad_(start.motion.psi_rad) {}

Pilot::Order Pilot::at(double t_s, const Sensed& sensed) {
  target_distance_m_ = kNoTarget_m;
  Order order = std::visit([&](const auto& course) { return guidance(course, t_s, sensed); },
                           scenario_->guidance);
  order.course.psi_goal_rad = order.reference.psi_rad;
  if (order.finished || order.no_passage) order.reference.speed_mps = 0.0;
  if (scenario_->avoidance && !order.no_passage) steer_clear(sensed, order);
  if (scenario_->shaping) {
    // What the filter held before this sample, then one sample on.
    shape(*scenario_->shaping, order.reference.psi_rad, sample_time_s_, shaped_);
    order.reference.psi_rad = shaped_.psi_rad;
    order.reference.psi_rate_radps = shaped_.psi_rate_radps;
    order.reference.psi_accel_radps2 = shaped_.psi_accel_radps2;
  }
  return order;
}

Pilot::Order Pilot::guidance(const HeadingSteps& steps, double t_s, const Sensed&) {
  Order order;
  order.reference.psi_rad = heading_at(steps, t_s);
  order.reference.speed_mps = scenario_->speed_mps;
  return order;
}

/// Looked for once per leg, from where the vehicle then is.
bool Pilot::way_is_free(const Position<double>& from, const Position<double>& to, int leg) {
  if (!scenario_->avoidance) return true;
  if (leg_checked_ != leg) {
    const Avoidance<double>& a = *scenario_->avoidance;
    passage_ = passage_exists(scenario_->obstacles, a.vehicle_radius_m + a.clearance_m, from, to);
    leg_checked_ = leg;
  }
  return passage_;
}

Pilot::Order Pilot::guidance(const WaypointCourse& course, double, const Sensed& sensed) {
  const int count = static_cast<int>(course.points_m.size());
  const Waypoints<double> waypoints{course.points_m.data(), count, course.acceptance_m,
                                    course.skip_passed};
  const Position<double>& position_m = sensed.position_m;
  const auto guided = scenario_->avoidance
                          ? guide_past_covered(*scenario_->avoidance, scenario_->obstacles.data(),
                                               static_cast<int>(scenario_->obstacles.size()),
                                               waypoints, position_m, waypoints_)
                          : guide(waypoints, position_m, waypoints_);
  Order order;
  order.finished = guided.finished;
  order.reference.psi_rad = guided.psi_rad;
  order.course.leg = std::min(waypoints_.next, count - 1);
  order.course.target_m = course.points_m[static_cast<std::size_t>(order.course.leg)];
  order.course.cross_track_m =
      guided.finished ? 0.0
                      : from_line_m(waypoints_.leg_start_m, order.course.target_m, position_m);
  target_distance_m_ = distance_m(position_m, order.course.target_m);
  const bool last = order.course.leg == count - 1;
  order.reference.speed_mps =
      scenario_->speed_mps * (last ? share_left(course.slow_down_m, target_distance_m_) : 1.0);
  order.no_passage =
      !guided.finished && !way_is_free(position_m, order.course.target_m, waypoints_.next);
  return order;
}

Pilot::Order Pilot::guidance(const LineCourse& course, double, const Sensed& sensed) {
  const int count = static_cast<int>(course.points_m.size());
  const auto guided = follow_line(course, sensed, sample_time_s_, line_);
  Order order;
  order.finished = guided.finished;
  order.reference.psi_rad = guided.psi_rad;
  order.course.leg = std::min(line_.along.segment, count - 2);
  order.course.target_m = course.points_m[static_cast<std::size_t>(order.course.leg) + 1];
  order.course.cross_track_m = guided.cross_track_m;
  const bool last = order.course.leg == count - 2;
  if (last) target_distance_m_ = distance_m(sensed.position_m, order.course.target_m);
  order.reference.speed_mps =
      scenario_->speed_mps * (last ? share_left(course.slow_down_m, guided.to_go_m) : 1.0);
  order.no_passage = !guided.finished && !way_is_free(sensed.position_m, course.points_m.back(), 0);
  return order;
}

Pilot::Order Pilot::guidance(const LissajousCourse& course, double t_s, const Sensed& sensed) {
  const PathPoint<double> path = course.path.at(t_s);
  const PathGuidance<double> guided =
      course.closed_loop
          ? closed_path(path, course.position_gain_per_s, sensed.position_m,
                        sideslip_rad(sensed.motion.u_mps, sensed.motion.v_mps), held_rad_)
          : open_path(path, held_rad_);
  held_rad_ = guided.psi_rad;
  Order order;
  order.reference.psi_rad = guided.psi_rad;
  order.reference.psi_rate_radps = guided.psi_rate_radps;
  order.reference.speed_mps = scenario_->speed_mps > 0.0 ? scenario_->speed_mps : guided.speed_mps;
  order.course.target_m = path.position_m;
  const Position<double> ahead{path.position_m.x_m + path.vx_mps,
                               path.position_m.y_m + path.vy_mps};
  order.course.cross_track_m = from_line_m(path.position_m, ahead, sensed.position_m);
  return order;
}

void Pilot::steer_clear(const Sensed& sensed, Order& order) {
  const Avoided<double> avoided =
      avoid(*scenario_->avoidance, scenario_->obstacles.data(), sectors_.data(),
            static_cast<int>(scenario_->obstacles.size()), sensed.position_m, sensed.motion.psi_rad,
            sensed.motion.u_mps, order.reference.psi_rad, target_distance_m_, avoidance_);
  order.reference.speed_mps *= avoided.speed_share;
  if (!avoided.active) return;
  order.reference.psi_rad = avoided.psi_rad;
  order.reference.psi_rate_radps = 0.0;
}

}  // namespace awmr
