#include "awmr/validate/paper_scenarios.h"

#include "awmr/core/units.h"

namespace awmr {
namespace {

constexpr double kPathSpeed_mps = 1.0;  ///< commanded speed [paper 5.1]
/// Acceptance radius of the waypoints, and largest approach angle Delta of the line-following law.
/// Chosen by this project, because the paper does not print them.
constexpr double kAcceptance_m = 1.0;
constexpr double kDelta_deg = 60.0;

State<double> pose(double x_m, double y_m, double psi_deg) {
  State<double> state{};
  state.x_m = x_m;
  state.y_m = y_m;
  state.psi_rad = radians(psi_deg);
  return state;
}

LineOfSight<double> lane(double width_m) { return {radians(kDelta_deg), width_m, true}; }

/// Parameters of obstacle avoidance, chosen by this project because the paper's figure with them is
/// missing. The minimum manoeuvring distance is the turning radius of the steering mode (5 m at any
/// speed), plus 1 m, plus the distance driven in 1 s.
Avoidance<double> avoidance() {
  return {.mmd_base_m = 6.0,
          .mmd_per_speed_s = 1.0,
          .sigma_rad = radians(10.0),
          .vehicle_radius_m = 0.8,
          .clearance_m = 0.5,
          .hysteresis_m = 0.5,
          .side_hysteresis_rad = radians(90.0),
          .brake_m = 1.5};
}

}  // namespace

Scenario waypoint_scenario() {
  WaypointPath path;
  path.points_m = {{90, 20}, {80, 40}, {70, 20}, {80, 0}};  // the paper's points E, F, G, H
  path.acceptance_m = kAcceptance_m;
  return {.name = "C8 waypoints by line of sight",
          .duration_s = 180.0,
          .initial = pose(80.0, 0.0, 0.0),
          .speed_mps = kPathSpeed_mps,
          .guidance = path};
}

Scenario line_scenario() {
  return {
      .name = "C9 line following",
      .duration_s = 120.0,
      .initial = pose(0.0, 10.0, 0.0),
      .speed_mps = kPathSpeed_mps,
      .guidance = LinePath{
          .points_m = {{0, 0}, {50, 25}}, .law = lane(5.0), .corner_m = 0.0, .slow_down_m = {}}};
}

Scenario obstacle_on_line_scenario() {
  return {
      .name = "C10 obstacle on a line",
      .duration_s = 120.0,
      .initial = {},
      .speed_mps = kPathSpeed_mps,
      .guidance =
          LinePath{
              .points_m = {{0, 0}, {60, 0}}, .law = lane(5.0), .corner_m = 0.0, .slow_down_m = {}},
      .obstacles = {{{30.0, 0.5}, 1.5}},
      .avoidance = avoidance()};
}

Scenario obstacle_between_waypoints_scenario() {
  Scenario scenario = waypoint_scenario();
  scenario.name = "C10 obstacle between waypoints";
  scenario.obstacles = {{{85.0, 30.4}, 1.5}, {{75.0, 29.6}, 1.5}};
  scenario.avoidance = avoidance();
  return scenario;
}

Scenario lissajous_scenario(bool closed_loop) {
  return {
      .name = closed_loop ? "C11 timed path, position fed back" : "C11 timed path, heading alone",
      .duration_s = 628.0,  // one period: 2 pi/0.01 s
      .initial = pose(10.0, 0.0, 90.0),
      .speed_mps = 0.0,
      .guidance = LissajousPath{.path = {10.0, 10.0, 0.01, 0.03},
                                .closed_loop = closed_loop,
                                .position_gain_per_s = 0.5,
                                .tolerance_m = 1.0}};
}

Scenario polyline_scenario() {
  return {.name = "C12 polyline",
          .duration_s = 150.0,
          .initial = pose(80.0, 0.0, 0.0),
          .speed_mps = kPathSpeed_mps,
          .guidance = LinePath{.points_m = {{80, 0}, {90, 20}, {80, 40}, {70, 20}, {80, 0}},
                               .law = lane(3.0),
                               .corner_m = 2.0,
                               .slow_down_m = {}}};
}

}  // namespace awmr
