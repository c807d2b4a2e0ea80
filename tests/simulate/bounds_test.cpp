/// For any plant and scenario: finite and bounded results, commands within limits, bounded work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <chrono>
#include <cmath>

#include "awmr/simulate/physics.h"
#include "simulate/disturbances.h"
#include "simulate/paper_plant.h"
#include "support/any_robot.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

Guidance any_guidance(double beyond) {
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return OpenLoop{between(-4.0 * beyond, 4.0 * beyond), between(-1.0 * beyond, 1.0 * beyond)};
    case 1:
      return HeadingSteps{{{0.0, between(-400.0 * beyond, 400.0 * beyond)}, {0.5, 0.0}}};
    case 2:
      return WaypointPath{.points_m = {{between(-9.0, 9.0) * beyond, 0.0}, {1.0, 1.0}},
                          .acceptance_m = 0.2,
                          .skip_passed = false,
                          .slow_down_m = {}};
    case 3:
      return LinePath{.points_m = {{-1.0, 0.0}, {0.1, between(-1.0, 1.0)}, {9.0 * beyond, 1.0}},
                      .law = PurePursuit<double>{ratio_between(1e-3, 10.0 * beyond), true},
                      .corner_m = 0.0,
                      .slow_down_m = {}};
    case 4:
      return LinePath{.points_m = {{-1.0, between(-1.0, 1.0)}, {9.0 * beyond, 1.0}},
                      .law = IntegralLos<double>{ratio_between(1e-3, 10.0 * beyond),
                                                 ratio_between(1e-3, 10.0 * beyond), true},
                      .corner_m = 0.0,
                      .slow_down_m = {}};
    default:
      return LissajousPath{.path = {10.0 * beyond, 10.0, 0.1 * beyond, 0.3}, .closed_loop = true};
  }
}

Scenario any_scenario(double beyond) {
  Scenario s{.name = "any",
             .duration_s = 0.5,
             .initial = {},
             .speed_mps = between(0.0, 3.0 * beyond),
             .guidance = any_guidance(beyond)};
  if (std::holds_alternative<LissajousPath>(s.guidance)) s.speed_mps = 0.0;
  s.initial.psi_rad = between(-100.0, 100.0) * beyond;
  s.initial.u_mps = between(-3.0, 3.0) * beyond;
  s.initial.v_mps = between(-1.0, 1.0) * beyond;
  s.initial.r_radps = between(-3.0, 3.0) * beyond;
  s.disturbance.surge = {constant(between(-1.0, 1.0) * beyond)};
  s.disturbance.yaw = {constant(between(-0.5, 0.5) * beyond, 0.2)};
  if (!std::holds_alternative<OpenLoop>(s.guidance) && *rc::gen::arbitrary<bool>()) {
    s.control.lqi = {ratio_between(0.01, 3.0), ratio_between(0.01, 10.0 * beyond),
                     ratio_between(0.01, 100.0), ratio_between(1e-3, 3.0 * beyond)};
  }
  return s;
}

/// Upper bound of the speed: the initial speed plus the largest force over the whole run, without
/// resistance.
double largest_speed(const Plant<double>& p, const Scenario& s, double force) {
  const double energy =
      p.mass_norm * (s.initial.u_mps * s.initial.u_mps + s.initial.v_mps * s.initial.v_mps);
  return 1.5 * (std::sqrt(energy / p.mass_norm) + 2.0 * force * s.duration_s / p.mass_norm) + 1.0;
}

void is_finite_bounded_and_within_limits(double beyond) {
  const Plant<double> plant = any_plant(beyond);
  const Scenario scenario = any_scenario(beyond);
  Vehicle vehicle = paper_vehicle();
  const auto controller = make_controller(plant, vehicle, {{3.0, 50.0, 12.0}, {2.0 * beyond, 0.5}});
  // Skips plants with time constants of microseconds, whose runs take long. Few of the random
  // plants are of this kind.
  if (substeps_for(plant, {}, 0.01) > 500) return;
  for (const YawMode mode : kYawModes) {
    const awmr::Run run = simulate(plant, controller, scenario, mode, {});
    RC_ASSERT(run.end != RunEnd::kFailed);
    const double most_mps = largest_speed(plant, scenario, 4.0 + beyond);
    for (const RunRow& row : run.rows) {
      const State<double>& s = row.state;
      RC_ASSERT(std::isfinite(s.x_m) && std::isfinite(s.y_m) && std::isfinite(s.psi_rad));
      RC_ASSERT(std::hypot(s.u_mps, s.v_mps) <= most_mps);
      RC_ASSERT(std::abs(row.force.left) <= 1.0 && std::abs(row.force.right) <= 1.0);
      RC_ASSERT(std::abs(row.steering_command_rad) <= plant.steering_max_rad * (1.0 + 1e-12));
      RC_ASSERT(std::abs(s.steering_rad) <= plant.steering_max_rad * (1.0 + 1e-9));
    }
  }
}

RC_GTEST_PROP(Bounds, InThePhysicalBoxARunIsFiniteBoundedAndWithinItsLimits, ()) {
  is_finite_bounded_and_within_limits(1.0);
}

RC_GTEST_PROP(Bounds, TenTimesOutsideTheBoxTheSameHolds, ()) {
  is_finite_bounded_and_within_limits(10.0);
}

Scenario coasting(double r_radps, double duration_s = 2.0) {
  Scenario s{.name = "coast",
             .duration_s = duration_s,
             .initial = {},
             .speed_mps = 0.0,
             .guidance = OpenLoop{}};
  s.initial.r_radps = r_radps;
  return s;
}

awmr::Run run_of(const Plant<double>& plant, const Scenario& scenario) {
  return simulate(plant, make_controller(plant, paper_vehicle(), {}), scenario,
                  YawMode::kDifferential, {});
}

TEST(Bounds, IntegratesAStiffResistanceStably) {
  // With b3 = 4 at -121 deg/s, g3'(r)/I'z is 940 1/s. RK4 with steps of 3.3 ms would overflow.
  Plant<double> plant = paper_plant();
  plant.yaw.beta = 4.0;
  for (const double r0 : {-121.0, -12100.0, 5e4}) {
    const double start = radians(r0);
    const awmr::Run run = run_of(plant, coasting(start));
    ASSERT_EQ(run.end, RunEnd::kDuration) << r0;
    for (const RunRow& row : run.rows) {
      // Exact solution: dr/dt = -a |r|^4/I'z  =>  1/|r|^3 = 1/|r0|^3 + 3 a t/I'z
      const double inverse =
          std::pow(std::abs(start), -3.0) + 3.0 * plant.yaw.alpha * row.t_s / plant.inertia_norm;
      const double expected = std::copysign(std::cbrt(1.0 / inverse), start);
      // Tolerance: the steps are at most one time constant of the transient. The error of such a
      // step is 1^5/120 of the rest of the transient.
      ASSERT_NEAR(row.state.r_radps, expected, 1e-3 * std::abs(expected)) << r0 << " " << row.t_s;
    }
  }
}

TEST(Bounds, SpeedsThatNoStepResolvesEndTheRunAndDoNotReachARow) {
  Plant<double> plant = paper_plant();
  plant.yaw.beta = 20.0;
  const awmr::Run run = run_of(plant, coasting(1e3));
  EXPECT_EQ(run.end, RunEnd::kFailed);
  ASSERT_FALSE(run.rows.empty());
  for (const RunRow& row : run.rows) EXPECT_TRUE(std::isfinite(row.state.r_radps));
  const Status failure = failure_of(run, coasting(1e3));
  ASSERT_FALSE(failure.has_value());
  EXPECT_EQ(exit_code(failure.error()), 2);
}

TEST(Bounds, StepsPerSampleDoNotOverflowTheirInteger) {
  for (const int which : {0, 1, 2}) {
    Plant<double> plant = paper_plant();
    if (which == 0) plant.mass_norm = 1e-12;
    if (which == 1) plant.sway_alpha = 1e12;
    if (which == 2) plant.steering_time_constant_s = 1e-12;
    EXPECT_GT(substeps_for(plant, {}, 0.01), 1000000) << which;
    const Status refused = check_work(plant, "model.json", coasting(0.1), 0.01);
    ASSERT_FALSE(refused.has_value()) << which;
    const char* named[] = {"model.json:/s", "model.json:/sway/alpha",
                           "model.json:/steering/time_constant_s"};
    EXPECT_THAT(to_text(refused.error()), HasSubstr(named[which]));
    EXPECT_EQ(run_of(plant, coasting(0.1)).end, RunEnd::kFailed);
  }
}

TEST(Bounds, RefusesADurationWithTooManyRowsBeforeItStarts) {
  for (const double duration_s : {1e18, 1e7, 1e300, 2.1e4}) {
    const Status refused = check_work(paper_plant(), "model.json", coasting(0.1, duration_s), 0.01);
    ASSERT_FALSE(refused.has_value()) << duration_s;
    EXPECT_THAT(to_text(refused.error()), HasSubstr("duration_s"));
    const awmr::Run run = run_of(paper_plant(), coasting(0.1, duration_s));
    EXPECT_EQ(run.end, RunEnd::kFailed);
    EXPECT_EQ(run.rows.size(), 1u);
  }
  EXPECT_TRUE(check_work(paper_plant(), "model.json", coasting(0.1, 1.9e4), 0.01).has_value());
}

TEST(Bounds, ANonFiniteDisturbanceEndsTheRunBeforeItsRow) {
  Scenario scenario = coasting(0.0);
  scenario.disturbance.surge = {constant(1e308, 0.5)};
  const awmr::Run run = run_of(paper_plant(), scenario);
  EXPECT_EQ(run.end, RunEnd::kFailed);
  for (const RunRow& row : run.rows) EXPECT_TRUE(std::isfinite(row.state.u_mps));
}

TEST(Bounds, AHeadingManyTurnsAwayTakesNoLongerThanAnyOther) {
  Scenario scenario = coasting(0.0, 1.0);
  scenario.guidance = HeadingSteps{{{0.0, radians(1e10)}}};
  scenario.speed_mps = 1.0;
  const auto start = std::chrono::steady_clock::now();
  const Plant<double> plant = paper_plant();
  const awmr::Run run =
      simulate(plant, make_controller(plant, paper_vehicle(), {{3, 50, 12}, {2, 0.5}}), scenario,
               YawMode::kCombined, {});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(run.end, RunEnd::kDuration);
  EXPECT_LT(taken.count(), 10.0);  // an earlier version took over 50 s
}

}  // namespace
}  // namespace awmr::testing
