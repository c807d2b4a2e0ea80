/// Closed loops with a GPS of 1.5 m of noise, 5 Hz and 0.2 s of latency: no jumps of the heading
/// reference, no waypoint counted as passed that was not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/simulate.h"
#include "simulate/paper_plant.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

constexpr double kAcceptance_m = 1.5;

Scenario with_gps(Guidance guidance) {
  Scenario s{.name = "GPS",
             .duration_s = 150.0,
             .initial = {},
             .speed_mps = 1.0,
             .guidance = std::move(guidance)};
  Gps gps;
  gps.rate_hz = 5.0;
  gps.latency_s = 0.2;
  gps.x.noise = gps.y.noise = 1.5;
  Sensors sensors;
  sensors.heading = {.noise = radians(0.5), .bias = radians(1.0)};
  sensors.yaw_rate.noise = radians(0.3);
  sensors.speed.noise = 0.02;
  sensors.sway_measured = false;
  sensors.gps = gps;
  s.sensors = sensors;
  return s;
}
Scenario waypoints() {
  return with_gps(WaypointPath{.points_m = {{20.0, 10.0}, {40.0, 0.0}, {60.0, 10.0}, {80.0, 0.0}},
                               .acceptance_m = kAcceptance_m,
                               .slow_down_m = {}});
}
Scenario line() {
  return with_gps(LinePath{.points_m = {{0.0, 0.0}, {80.0, 0.0}},
                           .law = LineOfSight<double>{radians(60.0), 4.0, false},
                           .slow_down_m = {}});
}

struct Figures {
  double jump_deg = 0.0;       ///< largest step of psi_ref other than at a waypoint
  int wrong = 0;               ///< waypoints counted as passed beyond acceptance + 2 m
  int unfinished = 0;          ///< runs that do not reach the end of their path
  double cross_track_m = 0.0;  ///< RMS of the true position from the line through the leg
  double position_m = 0.0;     ///< RMS error of the position
};

double from_leg_m(const Scenario& s, const RunRow& row) {
  const auto* path = std::get_if<WaypointPath>(&s.guidance);
  const auto leg = static_cast<std::size_t>(row.path.leg);
  const Position<double> from =
      path && leg > 0 ? path->points_m[leg - 1] : Position<double>{0.0, 0.0};
  const Position<double> along = seen_from(from, row.path.target_m);
  const Position<double> at = seen_from(from, {row.state.x_m, row.state.y_m});
  return (along.x_m * at.y_m - along.y_m * at.x_m) / std::hypot(along.x_m, along.y_m);
}

Figures figures(const Scenario& scenario, std::uint64_t seeds) {
  const Plant<double> plant = paper_plant();
  const Controller<double> controller = make_controller(plant, paper_vehicle(), kPaperGains);
  Figures f;
  double rows = 0.0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SimulateOptions options;
    options.sample = seed;
    const awmr::Run run = simulate(plant, controller, scenario, YawMode::kCombined, options);
    const bool finished = run.end == RunEnd::kFinished;
    if (!finished) ++f.unfinished;
    for (std::size_t k = 1; k < run.rows.size(); ++k) {
      const RunRow& a = run.rows[k - 1];
      const RunRow& b = run.rows[k];
      const Position<double> at{b.state.x_m, b.state.y_m};
      f.cross_track_m += std::pow(from_leg_m(scenario, b), 2);
      f.position_m += squared_distance_m2(b.measured_position_m, at);
      rows += 1.0;
      if (a.path.leg == b.path.leg) {
        const double jump = std::remainder(b.psi_ref_rad - a.psi_ref_rad, 2.0 * pi<double>());
        f.jump_deg = std::max(f.jump_deg, degrees(std::abs(jump)));
      }
      const bool passed = a.path.leg != b.path.leg || (finished && k + 1 == run.rows.size());
      if (passed && distance_m(a.path.target_m, at) > kAcceptance_m + 2.0) ++f.wrong;
    }
  }
  f.cross_track_m = std::sqrt(f.cross_track_m / rows);
  f.position_m = std::sqrt(f.position_m / rows);
  std::cout << scenario.name << ": psi_ref steps by at most " << f.jump_deg << " deg, " << f.wrong
            << " waypoints wrongly passed, cross-track RMS " << f.cross_track_m
            << " m, position RMS " << f.position_m << " m\n";
  return f;
}

TEST(PositionInTheLoop, LeadsAlongWaypointsWithoutJumps) {
  const Figures f = figures(waypoints(), 200);
  EXPECT_LT(f.jump_deg, 5.0);
  EXPECT_EQ(f.wrong, 0);
  EXPECT_EQ(f.unfinished, 0);
  // Expected error: the variance of the fixes times 2 K/(2 - K) with K = 0.064, plus the drift by a
  // heading error of 1 deg.
  EXPECT_LT(f.position_m, 0.45);
  Scenario raw = waypoints();
  raw.estimator = PositionMethod::kNone;
  const Figures held = figures(raw, 20);
  EXPECT_GT(held.jump_deg, 90.0);
  EXPECT_GT(held.wrong, 0);
  EXPECT_LT(f.cross_track_m, 0.7 * held.cross_track_m);
}

TEST(PositionInTheLoop, FollowsALineWithoutJumps) {
  const Figures f = figures(line(), 50);
  EXPECT_LT(f.jump_deg, 5.0);
  EXPECT_EQ(f.unfinished, 0);
  Scenario raw = line();
  raw.estimator = PositionMethod::kNone;
  const Figures held = figures(raw, 20);
  EXPECT_GT(held.jump_deg, 45.0);
  EXPECT_LT(f.cross_track_m, held.cross_track_m);
}

TEST(PositionInTheLoop, SurvivesDropOutsOfThreeSeconds) {
  for (Scenario s : {waypoints(), line()}) {
    s.sensors->gps->dropouts = {{20.0, 23.0}, {42.0, 45.0}, {64.0, 67.0}};
    const Figures f = figures(s, 50);
    EXPECT_LT(f.jump_deg, 5.0);
    EXPECT_EQ(f.wrong, 0);
    EXPECT_EQ(f.unfinished, 0);
    EXPECT_LT(f.position_m, 0.5);
  }
}

}  // namespace
}  // namespace awmr::testing
