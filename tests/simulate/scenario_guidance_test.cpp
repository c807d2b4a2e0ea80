/// Guidance of a scenario's path from sample to sample, checked by hand.
#include "awmr/simulate/scenario_guidance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "awmr/simulate/closed_loop.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/simulate.h"
#include "simulate/paper_plant.h"

namespace awmr::testing {
namespace {

/// Measurements of a vehicle at this position that drives at 1 m/s along x.
Sensed at(double x_m, double y_m) { return {{0.0, 1.0, 0.0, 0.0}, {x_m, y_m}}; }

Scenario along(Guidance guidance) {
  Scenario scenario;
  scenario.speed_mps = 2.0;
  scenario.guidance = std::move(guidance);
  return scenario;
}

TEST(ScenarioGuidance, CommandsTheHeadingOfTheLastStep) {
  const HeadingSteps steps{{{0.0, 0.1}, {2.0, 0.2}, {5.0, 0.3}}};
  EXPECT_EQ(heading_at(steps, 0.0), 0.1);
  EXPECT_EQ(heading_at(steps, 1.99), 0.1);
  EXPECT_EQ(heading_at(steps, 2.0), 0.2);
  EXPECT_EQ(heading_at(steps, 5.0), 0.3);
  EXPECT_EQ(heading_at(steps, 9.0), 0.3);
}

/// Expects the first leg, towards (10 m, 0), at full speed and at this distance from the leg.
void expect_on_first_leg(const GuidanceOutput& output, double cross_track_m) {
  EXPECT_EQ(output.path.leg, 0);
  EXPECT_EQ(output.path.target_m.x_m, 10.0);
  EXPECT_EQ(output.path.target_m.y_m, 0.0);
  EXPECT_NEAR(output.path.cross_track_m, cross_track_m, 1e-12);
  EXPECT_EQ(output.reference.speed_mps, 2.0);
}

TEST(ScenarioGuidance, GoesToOnePointAfterTheOtherAndSlowsDownBeforeTheLast) {
  const Scenario scenario = along(WaypointPath{
      .points_m = {{10.0, 0.0}, {10.0, 10.0}}, .acceptance_m = 1.0, .slow_down_m = 4.0});
  ScenarioGuidance guidance(scenario, 0.01);
  (void)guidance.step(0.0, at(0.0, 0.0));
  const GuidanceOutput first =
      guidance.step(0.01, at(7.5, 0.5));  // within 4 m of a point, but not of the last
  expect_on_first_leg(first, 0.5);
  const GuidanceOutput last = guidance.step(0.02, at(10.0, 0.5));
  EXPECT_EQ(last.path.leg, 1);
  EXPECT_EQ(last.path.target_m.y_m, 10.0);
  EXPECT_EQ(last.reference.speed_mps, 2.0);
  EXPECT_NEAR(guidance.step(0.03, at(10.0, 8.0)).reference.speed_mps, 1.0, 1e-12);  // 2 m of 4
  const GuidanceOutput there = guidance.step(0.04, at(10.0, 9.5));
  EXPECT_TRUE(there.finished);
  EXPECT_EQ(there.reference.speed_mps, 0.0);
  EXPECT_EQ(there.path.leg, 1);
  EXPECT_EQ(there.path.cross_track_m, 0.0);
}

TEST(ScenarioGuidance, FollowsALineToItsEndAndSlowsDownBeforeIt) {
  const Scenario scenario = along(LinePath{.points_m = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}},
                                           .law = LineOfSight<double>{1.0, 1.0, false},
                                           .slow_down_m = 4.0});
  ScenarioGuidance guidance(scenario, 0.01);
  (void)guidance.step(0.0, at(0.0, 0.0));
  const GuidanceOutput first = guidance.step(0.01, at(7.0, 0.2));
  expect_on_first_leg(first, 0.2);
  const GuidanceOutput last = guidance.step(0.02, at(10.2, 7.0));
  EXPECT_EQ(last.path.leg, 1);
  EXPECT_EQ(last.path.target_m.y_m, 10.0);
  EXPECT_NEAR(last.path.cross_track_m, -0.2, 1e-12);
  EXPECT_NEAR(last.reference.speed_mps, 2.0 * 3.0 / 4.0, 1e-12);
  const GuidanceOutput there = guidance.step(0.03, at(10.0, 10.1));
  EXPECT_TRUE(there.finished);
  EXPECT_EQ(there.path.leg, 1);
  EXPECT_EQ(there.reference.speed_mps, 0.0);
}

TEST(ScenarioGuidance, FollowsAPathAtItsSpeedOrAtTheScenarios) {
  LissajousPath path;
  path.path = {10.0, 8.0, 0.1, 0.3};
  Scenario scenario = along(path);
  scenario.speed_mps = 0.0;
  ScenarioGuidance guidance(scenario, 0.01);
  (void)guidance.step(0.0, at(10.0, 0.0));
  const PathPoint<double> point = path.path.at(3.0);
  const GuidanceOutput output = guidance.step(3.0, at(point.position_m.x_m, point.position_m.y_m));
  EXPECT_NEAR(output.reference.psi_rad, std::atan2(point.vy_mps, point.vx_mps), 1e-12);
  EXPECT_NEAR(output.reference.speed_mps, std::hypot(point.vx_mps, point.vy_mps), 1e-12);
  EXPECT_EQ(output.path.target_m.x_m, point.position_m.x_m);
  EXPECT_NEAR(output.path.cross_track_m, 0.0, 1e-12);
  scenario.speed_mps = 1.5;
  EXPECT_EQ(ScenarioGuidance(scenario, 0.01).step(0.0, at(10.0, 0.0)).reference.speed_mps, 1.5);
}

TEST(Clearance, IsBetweenTheCircles) {
  Scenario scenario;
  scenario.obstacles = {{{3.0, 4.0}, 1.0}, {{50.0, 0.0}, 1.0}};
  EXPECT_NEAR(clearance_m(scenario, {}), 4.0, 1e-15);
  scenario.avoidance.emplace();
  scenario.avoidance->vehicle_radius_m = 0.5;
  EXPECT_NEAR(clearance_m(scenario, {}), 3.5, 1e-15);
}

TEST(Battery, FallsFromItsFirstTimeToItsLast) {
  const Battery battery{.from_s = 5.0, .to_s = 20.0, .share_end = 0.2};
  EXPECT_EQ(battery_share(battery, 5.0), 1.0);
  EXPECT_NEAR(battery_share(battery, 12.5), 0.6, 1e-15);
  EXPECT_NEAR(battery_share(battery, 20.0), 0.2, 1e-15);
  EXPECT_NEAR(battery_share(battery, 99.0), 0.2, 1e-15);
}

TEST(ControllerInAScenario, HasItsSplitAndItsForm) {
  const Controller<double> own = make_controller(paper_plant(), paper_vehicle(), {});
  Scenario scenario;
  EXPECT_EQ(controller_in(scenario, own).limits.split, own.limits.split);
  EXPECT_EQ(controller_in(scenario, own).limits.form, own.limits.form);
  scenario.control.split = CombinedSplit::kFixedHalf;
  scenario.control.allocation = AllocationForm::kPaper;
  EXPECT_EQ(controller_in(scenario, own).limits.split, CombinedSplit::kFixedHalf);
  EXPECT_EQ(controller_in(scenario, own).limits.form, AllocationForm::kPaper);
}

}  // namespace
}  // namespace awmr::testing
