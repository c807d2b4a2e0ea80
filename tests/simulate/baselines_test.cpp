/// Characteristic behaviour of the baselines in closed loop, compared with the paper's laws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/metrics.h"
#include "simulate/disturbances.h"
#include "simulate/paper_plant.h"

namespace awmr::testing {
namespace {

constexpr LqiWeights<double> kWeights{radians(5.0), radians(20.0), radians(20.0), 0.02};

Scenario heading_scenario(double psi_rad, double duration_s) {
  Scenario s{.name = "heading",
             .duration_s = duration_s,
             .initial = {},
             .speed_mps = 1.0,
             .guidance = HeadingSteps{{{0.0, psi_rad}}}};
  s.initial.u_mps = 1.0;
  return s;
}

Scenario line_scenario(std::vector<Position<double>> points_m, AnyLineLaw law, double y_m = 0.0) {
  Scenario s{.name = "line",
             .duration_s = 200.0,
             .initial = {},
             .speed_mps = 1.0,
             .guidance = LinePath{
                 .points_m = std::move(points_m), .law = law, .corner_m = 0.0, .slow_down_m = {}}};
  s.initial.y_m = y_m;
  s.initial.u_mps = 1.0;
  return s;
}

awmr::Run paper_run(const Scenario& scenario, YawMode mode,
                    const Vehicle& vehicle = paper_vehicle()) {
  const Plant<double> plant = paper_plant();
  return simulate(plant, make_controller(plant, vehicle, kPaperGains), scenario, mode, {});
}

double overshoot_rad(const awmr::Run& run, double psi_rad) {
  double most = 0.0;
  for (const RunRow& row : run.rows) most = std::max(most, row.state.psi_rad - psi_rad);
  return most;
}

/// The moment first causes a heading error of 3 deg. The slowest pole of the loop is -0.24 1/s, so
/// after 100 s the fraction exp(-24) of this error remains. world_test.cpp checks the error of the
/// sliding mode.
TEST(LqiInTheLoop, LeavesNoHeadingErrorUnderAConstantYawMoment) {
  Scenario s = heading_scenario(0.0, 100.0);
  s.disturbance.yaw = {constant(0.01)};
  for (const YawMode mode : kYawModes) {
    s.control.lqi.reset();
    EXPECT_GT(std::abs(paper_run(s, mode).rows.back().state.psi_rad), radians(2.0))
        << name_of(mode);
    s.control.lqi = kWeights;
    EXPECT_LT(std::abs(paper_run(s, mode).rows.back().state.psi_rad), 1e-6) << name_of(mode);
  }
}

/// A loop with an integral overshoots every step, because the integral of e must return to 0. Force
/// limits would add windup: with a fifth of the force the turn takes longer, and an integral that
/// continued meanwhile would overshoot by far more.
TEST(LqiInTheLoop, DoesNotWindUpInALargeTurnAtTheLimitsOfTheForces) {
  const double psi_rad = radians(170.0);
  Scenario s = heading_scenario(psi_rad, 60.0);
  s.control.lqi = kWeights;
  s.speed_mps = 0.2;
  s.initial.u_mps = 0.2;
  Vehicle weak = paper_vehicle();
  weak.wheel_force = {-0.2, 0.2};
  const awmr::Run free = paper_run(s, YawMode::kDifferential);
  const awmr::Run limited = paper_run(s, YawMode::kDifferential, weak);
  EXPECT_NEAR(limited.rows.back().state.psi_rad, psi_rad, radians(0.1));
  EXPECT_LT(overshoot_rad(limited, psi_rad), overshoot_rad(free, psi_rad) + radians(1.0));
}

/// The side slope of configs/scenarios/side_slope.json and its moment, without its noise.
Scenario on_a_side_slope(const AnyLineLaw& law) {
  Scenario s = line_scenario({{0.0, 0.0}, {150.0, 0.0}}, law);
  s.disturbance.slope = Slope{radians(8.0), radians(-90.0)};
  s.disturbance.yaw = {constant(0.01)};
  return s;
}

double last_cross_track_m(const Scenario& scenario, YawMode mode) {
  const awmr::Run run = paper_run(scenario, mode);
  return run.rows[run.rows.size() - 2].path.cross_track_m;
}

TEST(IlosInTheLoop, LeavesNoOffsetOnASideSlopeWhereLineOfSightDoes) {
  for (const YawMode mode : kYawModes) {
    for (const bool compensated : {true, false}) {
      const LineOfSight<double> los{radians(60.0), 5.0, compensated};
      const IntegralLos<double> ilos{3.0, 0.3, compensated};
      EXPECT_GT(std::abs(last_cross_track_m(on_a_side_slope(los), mode)), 0.05) << name_of(mode);
      // The integral y_int converges at a rate of at least sigma/Delta = 0.1 1/s. The drive lasts
      // 150 s.
      EXPECT_LT(std::abs(last_cross_track_m(on_a_side_slope(ilos), mode)), 1e-3) << name_of(mode);
    }
  }
}

TEST(PurePursuitInTheLoop, ReachesALineFromTheSide) {
  for (const YawMode mode : kYawModes) {
    const Scenario s =
        line_scenario({{0.0, 0.0}, {80.0, 0.0}}, PurePursuit<double>{3.0, true}, 6.0);
    const awmr::Run run = paper_run(s, mode);
    EXPECT_EQ(run.end, RunEnd::kFinished);
    EXPECT_NEAR(run.rows[run.rows.size() - 2].path.cross_track_m, 0.0, 1e-3) << name_of(mode);
  }
}

/// Near the line the distance e decreases as e_dot = -k e u/(k_s + u), which is about -k e at every
/// speed well above k_s. After ln(10)/k seconds, a tenth of the distance remains.
TEST(StanleyInTheLoop, ApproachesTheLineInTheSameTimeAtAnySpeed) {
  for (const double speed_mps : {0.5, 1.0}) {
    Scenario s = line_scenario({{0.0, 0.0}, {100.0, 0.0}}, Stanley<double>{0.2, 0.01, true}, 0.3);
    s.speed_mps = s.initial.u_mps = speed_mps;
    s.duration_s = std::log(10.0) / 0.2;
    for (const YawMode mode : kYawModes) {
      EXPECT_NEAR(paper_run(s, mode).rows.back().path.cross_track_m, 0.03, 0.01) << name_of(mode);
    }
  }
}

/// The corner is cut on the inside. Because the goal is at the distance L from the vehicle, the
/// vehicle stays within L/2 of the lines that form a right angle. Steering mode is not tested: with
/// its minimum turning radius of 5 m, the vehicle swings out.
TEST(PurePursuitInTheLoop, RoundsACornerOnItsInside) {
  const Scenario s =
      line_scenario({{0.0, 0.0}, {30.0, 0.0}, {30.0, 40.0}}, PurePursuit<double>{4.0, true});
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kCombined}) {
    const awmr::Run run = paper_run(s, mode);
    EXPECT_EQ(run.end, RunEnd::kFinished);
    for (const RunRow& row : run.rows) {
      EXPECT_LT(std::abs(row.path.cross_track_m), 2.0) << name_of(mode) << row.t_s;
      EXPECT_LT(row.state.x_m, 30.5) << name_of(mode) << row.t_s;
    }
  }
}

}  // namespace
}  // namespace awmr::testing
