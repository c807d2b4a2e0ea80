/// Metrics of hand-made runs, compared with values computed by hand.
#include "awmr/simulate/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/validity.h"
#include "simulate/paper_plant.h"

namespace awmr::testing {
namespace {

const Scenario kSteps{"step", 4.0, {}, 1.0, HeadingSteps{{{0.0, radians(10.0)}}}};

/// A 10 deg step with the heading `psi_deg` at 0, 1, 2, 3, 4 s, at 1 m/s along x.
awmr::Run by_hand(const double (&psi_deg)[5]) {
  awmr::Run run;
  for (int i = 0; i < 5; ++i) {
    RunRow row;
    row.t_s = i;
    row.state.psi_rad = radians(psi_deg[i]);
    row.state.x_m = i;
    row.state.u_mps = 1.0;
    row.psi_ref_rad = radians(10.0);
    row.u_ref_mps = 1.0;
    run.rows.push_back(row);
  }
  return run;
}

Metrics evaluate(const awmr::Run& run) {
  return metrics_of(run, kSteps, make_controller(paper_plant(), paper_vehicle(), {}));
}

TEST(Metrics, HeadingStepIsSettledFromTheFirstRowThatStaysInTheBand) {
  // The band is 0.5 deg; 10.4 at 2 s and 9.9 after it are inside, 11 at 1 s is not.
  const Metrics m = evaluate(by_hand({0.0, 11.0, 10.4, 9.9, 10.0}));
  EXPECT_TRUE(m.completed);
  EXPECT_EQ(m.settling_time_s, 2.0);
  EXPECT_NEAR(*m.overshoot_deg, 1.0, 1e-12);
  // Sum of |e| dt: 10 + 1 + 0.4 + 0.1. Sum of t |e| dt: 0 + 1 + 0.8 + 0.3.
  EXPECT_NEAR(*m.heading_iae_degs, 11.5, 1e-9);
  EXPECT_NEAR(*m.heading_itae_degs2, 2.1, 1e-9);
  EXPECT_EQ(m.path_length_m, 4.0);
}

TEST(Metrics, AStepThatNeverSettlesIsNotCompletedAndHasNoSettlingTime) {
  const Metrics m = evaluate(by_hand({0.0, 2.0, 4.0, 6.0, 8.0}));
  EXPECT_FALSE(m.completed);
  EXPECT_FALSE(m.settling_time_s);
  EXPECT_EQ(m.overshoot_deg, 0.0);
}

TEST(Metrics, SpeedDropCountsFromWhereTheSpeedWasReached) {
  awmr::Run run = by_hand({0.0, 10.0, 10.0, 10.0, 10.0});
  const double speeds[] = {0.0, 0.9, 1.0, 0.93, 1.0};
  for (int i = 0; i < 5; ++i) run.rows[static_cast<std::size_t>(i)].state.u_mps = speeds[i];
  EXPECT_NEAR(*evaluate(run).speed_drop_mps, 0.07, 1e-12);
  for (RunRow& row : run.rows) row.state.u_mps = 0.5;
  EXPECT_FALSE(evaluate(run).speed_drop_mps);
}

TEST(Metrics, APathThatSlowsDownAtItsEndHasNoSpeedDrop) {
  awmr::Run run = by_hand({0.0, 0.0, 0.0, 0.0, 0.0});
  run.rows[3].state.u_mps = 0.4;
  const auto drop = [&](const Guidance& guidance) {
    const Scenario scenario{"path", 4.0, {}, 1.0, guidance};
    return metrics_of(run, scenario, make_controller(paper_plant(), paper_vehicle(), {}))
        .speed_drop_mps;
  };
  WaypointPath waypoints{{{4.0, 0.0}}, 0.5, false, {}};
  LinePath line{{{0.0, 0.0}, {4.0, 0.0}}, LineOfSight<double>{1.0, 1.0, false}, 0.0, {}};
  EXPECT_NEAR(*drop(waypoints), 0.6, 1e-12);
  EXPECT_NEAR(*drop(line), 0.6, 1e-12);
  waypoints.slow_down_m = 1.0;
  line.slow_down_m = 1.0;
  EXPECT_FALSE(drop(waypoints));
  EXPECT_FALSE(drop(line));
  EXPECT_FALSE(drop(LissajousPath{}));
}

TEST(Metrics, ATimedPathIsCompletedWhereItStaysWithinTheToleranceInTheSecondHalf) {
  awmr::Run run = by_hand({0.0, 0.0, 0.0, 0.0, 0.0});
  const double off_m[] = {9.0, 9.0, 0.2, 0.3, 0.1};
  for (std::size_t i = 0; i < 5; ++i) {
    run.rows[i].path.target_m = {run.rows[i].state.x_m, off_m[i]};
  }
  const auto completed = [&](double tolerance_m) {
    LissajousPath path;
    path.tolerance_m = tolerance_m;
    const Scenario scenario{"path", 4.0, {}, 1.0, path};
    return metrics_of(run, scenario, make_controller(paper_plant(), paper_vehicle(), {})).completed;
  };
  EXPECT_TRUE(completed(0.3));
  EXPECT_FALSE(completed(0.29));
  EXPECT_TRUE(completed(LissajousPath{}.tolerance_m));
}

TEST(Metrics, ControlVariationIsPerSecondAndOverTheLimits) {
  awmr::Run run = by_hand({0.0, 10.0, 10.0, 10.0, 10.0});
  run.rows[1].steering_command_rad =
      radians(20.0);             // the steering moves to its stop and back: variation 2
  run.rows[2].force.left = 0.5;  // the left force rises to 0.5 F'max and falls back: variation 1
  EXPECT_NEAR(evaluate(run).control_variation, (2.0 + 1.0) / 4.0, 1e-12);
  Controller<double> weak = make_controller(paper_plant(), paper_vehicle(), {});
  weak.limits.force_max = 0.5;
  EXPECT_NEAR(metrics_of(run, kSteps, weak).control_variation, (2.0 + 2.0) / 4.0, 1e-12);
}

TEST(Metrics, WorkIsPositiveForceTimesTheWheelsSpeed) {
  awmr::Run run = by_hand({0.0, 0.0, 0.0, 0.0, 0.0});
  for (RunRow& row : run.rows) {
    row.state.u_mps = 0.8;
    row.state.r_radps = 0.5;
    row.acting = {-0.2, 0.6, -0.2, 0.6};
  }
  // d = 0.36 m: the left wheels run at 0.62 m/s and brake, so only the two right ones, which run at
  // 0.98 m/s, do positive work: 2 x 0.6 x 0.98 per second, for 4 s.
  const Metrics m = evaluate(run);
  EXPECT_NEAR(m.energy_mech, 4.0 * 2.0 * 0.6 * 0.98, 1e-12);
  EXPECT_NEAR(m.energy_electric, 4.0 * 2.0 * (0.04 + 0.36), 1e-12);
  EXPECT_NEAR(m.tyre_work, 4.0 * 0.3028 * std::pow(0.5, 0.825) * 0.5, 1e-12);
  EXPECT_EQ(m.saturation_s, 0.0);
  EXPECT_EQ(m.steering_travel_deg, 0.0);
  // The same energy computed wheel by wheel, for almost lossless motors.
  Controller<double> real = make_controller(paper_plant(), paper_vehicle(), {});
  real.limits.back_emf_s_per_m = 1e-12;
  EXPECT_NEAR(metrics_of(run, kSteps, real).energy_mech, m.energy_mech, 1e-9);
  EXPECT_NEAR(metrics_of(run, kSteps, real).energy_electric, m.energy_electric, 1e-9);
  // Two wheels do half the work of four.
  for (RunRow& row : run.rows) row.acting = {-0.2, 0.6, 0.0, 0.0};
  real.limits.is_rear_driven = false;
  EXPECT_NEAR(metrics_of(run, kSteps, real).energy_mech, 0.5 * m.energy_mech, 1e-9);
  EXPECT_NEAR(metrics_of(run, kSteps, real).energy_electric, 0.5 * m.energy_electric, 1e-9);
}

TEST(Metrics, WorkIsThatOfTheForcesBeyondTheDeadZone) {
  awmr::Run run = by_hand({0.0, 0.0, 0.0, 0.0, 0.0});
  for (RunRow& row : run.rows) {
    row.state.u_mps = 0.8;
    row.acting = {0.3, 0.6, 0.3, 0.6};
  }
  Controller<double> dead = make_controller(paper_plant(), paper_vehicle(), {});
  dead.limits.dead_zone = 0.1;
  const Metrics m = metrics_of(run, kSteps, dead);
  EXPECT_NEAR(m.energy_mech, 4.0 * 2.0 * (0.2 + 0.5) * 0.8, 1e-12);
  EXPECT_NEAR(m.energy_electric, 4.0 * 2.0 * (0.04 + 0.25), 1e-12);
}

TEST(Metrics, FrontWheelsRollAlongTheirAngle) {
  awmr::Run run = by_hand({0.0, 0.0, 0.0, 0.0, 0.0});
  for (RunRow& row : run.rows) {
    row.state.u_mps = 0.8;
    row.state.v_mps = 0.1;
    row.state.r_radps = 0.5;
    row.state.steering_rad = radians(20.0);
    row.acting = {0.5, 0.5, 0.5, 0.5};
  }
  // Rolling speeds, mean of left and right (the terms d r cancel): 0.8 cos 20 deg + (0.1 + 0.35 x
  // 0.5) sin 20 deg in front, 0.8 at the rear.
  const double front_mps = 0.8 * std::cos(radians(20.0)) + 0.275 * std::sin(radians(20.0));
  EXPECT_NEAR(evaluate(run).energy_mech, 4.0 * 2.0 * 0.5 * (front_mps + 0.8), 1e-12);
}

TEST(Metrics, TravelAndSaturationAreCountedOverTheRun) {
  awmr::Run run = by_hand({0.0, 0.0, 0.0, 0.0, 0.0});
  const double angles_deg[] = {0.0, 5.0, -5.0, 0.0, 0.0};
  for (std::size_t i = 0; i < 5; ++i) run.rows[i].state.steering_rad = radians(angles_deg[i]);
  run.rows[1].force.left = 1.0;
  run.rows[2].force.right = -1.0;
  run.rows[3].steering_command_rad = radians(-20.0);
  run.rows[4].force.left = 1.0;  // command of the last row, which acts for no sample
  const Metrics m = evaluate(run);
  EXPECT_NEAR(m.steering_travel_deg, 20.0, 1e-12);
  EXPECT_EQ(m.saturation_s, 3.0);
}

TEST(Metrics, OpenLoopHasNoHeadingMetrics) {
  const awmr::Run run = run_open_loop(paper_plant(), {}, 1.0, {1.0, 0.0});
  const Scenario open{"open", 1.0, {}, 0.0, OpenLoop{1.0, 0.0}};
  const Metrics m = metrics_of(run, open, make_controller(paper_plant(), paper_vehicle(), {}));
  EXPECT_FALSE(m.settling_time_s);
  EXPECT_FALSE(m.overshoot_deg);
  EXPECT_FALSE(m.speed_drop_mps);
  EXPECT_GT(m.path_length_m, 0.0);
}

TEST(ElectricWork, IsThatOfTheCopperAndOfTheWheels) {
  Metrics metrics;
  metrics.energy_electric = 3.0;  // unit: seconds of a stalled motor
  metrics.energy_mech = 2.0;      // unit: metres with the force F_max
  Vehicle vehicle = fitted_paper_model().vehicle;
  EXPECT_FALSE(electric_work_j(metrics, vehicle, 0.5));
  vehicle.motor_stall_power_w = 20.0;
  vehicle.mass_kg = 10.0;
  EXPECT_DOUBLE_EQ(*electric_work_j(metrics, vehicle, 0.5), 20.0 * 3.0 + 10.0 / 0.5 * 2.0);
}

/// Message of `beyond-trials` for a turn at 40 deg/s and a measured rate of 15 deg/s.
std::string extrapolated(const TurnCommands& commands) {
  const auto finding = extrapolation_finding("model.json", 15.0, 40.0, "run", commands);
  return finding ? finding->message : "";
}

TEST(Validity, AdvisesTheLimitThatTheScenarioLacks) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  using ::testing::Not;
  const auto record = HasSubstr("turning trials at up to 40 deg/s");
  const std::string option = option_text("heading_rate_limit");
  const std::string measured = option_text("heading_rate_limit measured");
  EXPECT_THAT(extrapolated({}), AllOf(record, HasSubstr(measured)));
  EXPECT_THAT(extrapolated({.rate_max_degps = 30.0}),
              AllOf(record, HasSubstr("from 30 to 15 deg/s"), HasSubstr(option)));
  // At 40/15 of the measured rate, the limit is lowered by this factor.
  for (const auto& [limit_degps, lower] : {std::pair(15.0, "5.6"), {12.0, "4.5"}}) {
    EXPECT_THAT(extrapolated({.rate_max_degps = limit_degps}),
                AllOf(record, HasSubstr(std::string("to about ") + lower + " deg/s"),
                      HasSubstr(option_text(std::string("heading_rate_limit ") + lower))));
  }
  EXPECT_THAT(extrapolated({.are_headings = false}),
              AllOf(record, HasSubstr("tau_turn"), Not(HasSubstr("heading"))));
}

TEST(Validity, TakesTheLimitOfTheHeadingRateFromTheScenario) {
  Scenario scenario = heading_steps({30.0});
  EXPECT_TRUE(turn_commands(scenario).are_headings);
  EXPECT_FALSE(turn_commands(scenario).rate_max_degps);
  limit_heading_rate(15.0, 0.01, scenario);
  EXPECT_NEAR(turn_commands(scenario).rate_max_degps.value(), 15.0, 1e-12);
  scenario.guidance = OpenLoop{1.0, 0.1};  // has no heading, so the limit has no effect
  EXPECT_FALSE(turn_commands(scenario).are_headings);
  EXPECT_FALSE(turn_commands(scenario).rate_max_degps);
}

/// With a bandwidth of 4 rad/s, the filter would oscillate at a sample time of 0.25 s and more.
TEST(Validity, TheLimitOfTheHeadingRateDoesNotOscillate) {
  for (const double sample_time_s : {0.01, 0.1, 0.2, 0.25, 0.5, 1.0}) {
    Scenario scenario = heading_steps({30.0});
    limit_heading_rate(50.0, sample_time_s, scenario);
    const double target_rad = radians(30.0);
    ShapedHeading<double> state = start_shaping(0.0);
    double most_rad = 0.0;
    for (double t_s = 0.0; t_s < 30.0; t_s += sample_time_s) {
      shape(*scenario.shaping, target_rad, sample_time_s, state);
      most_rad = std::max(most_rad, state.psi_rad);
    }
    EXPECT_NEAR(state.psi_rad, target_rad, 1e-3 * target_rad) << sample_time_s;
    EXPECT_LT(most_rad, 1.01 * target_rad) << sample_time_s;
  }
}

TEST(Validity, WarnsIfHeadingsAreNotRateLimited) {
  Model model = fitted_paper_model();
  const auto finding = heading_rate_not_limited("", model);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->code, "heading-rate-not-limited");
  EXPECT_FALSE(heading_rate_not_limited(kNoRate, model));  // a limit was given
  model.vehicle.yaw_rate_max_degps = 15.0;
  EXPECT_FALSE(heading_rate_not_limited("", model));
}

TEST(Validity, WarnsOfATurnFasterThanTheTrials) {
  Model model = fitted_paper_model();
  const auto finding_at = [&](double fastest_degps) {
    return extrapolation_finding(model.file, measured_yaw_rate_degps(model), fastest_degps,
                                 "C3, combined", {});
  };
  EXPECT_FALSE(measured_yaw_rate_degps(model));
  EXPECT_FALSE(finding_at(100.0));  // a model without turning trials has no measured range
  const auto trial = [](TrialKind kind, double measured) {
    TrialPoint point;
    point.kind = kind;
    point.measured = measured;
    return point;
  };
  model.record.trials = {trial(TrialKind::kTurning, radians(9.0)),
                         trial(TrialKind::kTurning, radians(15.0)), trial(TrialKind::kSurge, 1.6)};
  EXPECT_NEAR(*measured_yaw_rate_degps(model), 15.0, 1e-12);
  EXPECT_FALSE(finding_at(17.0));
  EXPECT_TRUE(finding_at(18.1));  // more than 1.2 times 15
  const auto finding = finding_at(77.0);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->code, "beyond-trials");
  EXPECT_NE(finding->message.find("C3, combined"), std::string::npos);
  EXPECT_NE(finding->message.find("5.1 times"), std::string::npos);
  model.vehicle.yaw_rate_max_degps = 80.0;
  EXPECT_FALSE(finding_at(77.0));
}

std::vector<std::string> codes_of(const std::vector<Finding>& findings) {
  std::vector<std::string> codes;
  for (const Finding& finding : findings) codes.push_back(finding.code);
  return codes;
}
using Codes = std::vector<std::string>;

TEST(Validity, WarnsOfScenarioPartsWithoutEffect) {
  const Model model = fitted_paper_model();
  EXPECT_EQ(codes_of(unattainable_requests(kSteps, model)), Codes{});

  Scenario after = kSteps;
  after.guidance = HeadingSteps{{{0.0, 0.1}, {3.9, 0.2}}};
  EXPECT_EQ(codes_of(unattainable_requests(after, model)), Codes{});
  after.guidance = HeadingSteps{{{0.0, 0.1}, {4.0, 0.2}}};
  EXPECT_EQ(codes_of(unattainable_requests(after, model)), Codes{"late-step"});

  Scenario blocked = kSteps;
  WaypointPath path;
  path.points_m = {{5.0, 0.0}, {10.0, 0.0}};
  path.acceptance_m = 0.5;
  blocked.guidance = path;
  blocked.obstacles = {{{10.0, 0.9}, 1.0}, {{5.0, 1.1}, 1.0}};
  const auto findings = unattainable_requests(blocked, model);
  ASSERT_EQ(codes_of(findings), Codes{"blocked-waypoint"});
  EXPECT_NE(findings[0].message.find("waypoint 2"), std::string::npos);

  // With all four wheels at F_max, the steady speed is 3.5 m/s, from 4 = 1.33 u^0.88.
  Scenario fast = kSteps;
  fast.speed_mps = 3.3;
  EXPECT_EQ(codes_of(unattainable_requests(fast, model)), Codes{});
  fast.speed_mps = 3.7;
  EXPECT_EQ(codes_of(unattainable_requests(fast, model)), Codes{"unreachable-speed"});
}

TEST(Validity, WarnsOfASpeedLawThatDrivesBackwardWithAnUnsignedSpeed) {
  Plant<double> plant = paper_plant();
  plant.mass_norm = 1.0;
  plant.surge = {.alpha = 1.0, .beta = 1.0};
  Gains<double> gains = kPaperGains;
  gains.speed = {0.9, 1.0};
  EXPECT_FALSE(unsigned_speed_finding(plant, paper_vehicle(), gains, ""));
  // With Coulomb friction, the law drives a vehicle that rolls backward at the speed u with 0.9 u
  // plus the friction fed forward, 0.12. Up to 0.2 m/s, this exceeds the resistance 0.1 + u.
  plant.surge.coulomb = 0.1;
  const auto finding = unsigned_speed_finding(plant, paper_vehicle(), gains, "");
  ASSERT_TRUE(finding);
  EXPECT_NE(finding->message.find("at 0.195 m/s"), std::string::npos) << finding->message;
  // Even with a tiny gain, the friction fed forward cancels the resistance at 0.02 m/s.
  gains.speed = {1e-6, 1.0};
  EXPECT_TRUE(unsigned_speed_finding(plant, paper_vehicle(), gains, ""));
}

/// Speed after 1 s of a vehicle that rolls backward at `speed_mps`, m/s, backward positive. The
/// reference speed is 0, and the speed sensor has no sign.
double backward_mps_after_1_s(const Plant<double>& plant, const Vehicle& vehicle,
                              const Gains<double>& gains, double speed_mps) {
  Scenario rolling{"rolling", 1.0, {}, 0.0, HeadingSteps{{{.t_s = 0.0, .psi_rad = 0.0}}}};
  rolling.initial.u_mps = -speed_mps;
  rolling.sensors.emplace().speed_signed = false;
  const awmr::Run run = simulate(plant, make_controller(plant, vehicle, gains), rolling,
                                 YawMode::kDifferential, {.sample_time_s = 0.01});
  return -run.rows.back().state.u_mps;
}

TEST(Validity, LimitsTheBackwardDriveByTheForcesOfTheMotors) {
  Plant<double> plant = paper_plant();
  plant.mass_norm = 1.0;
  plant.surge = {.alpha = 0.5, .beta = 1.0};
  const Gains<double> gains{.heading = kPaperGains.heading, .speed = {100.0, 50.0}};
  Vehicle vehicle = paper_vehicle();
  vehicle.wheel_force = {-0.5, 1.0};
  // The speed law requests 2 u. The resistance 0.5 u exceeds the largest force, 4 x 0.5, from 4 m/s.
  auto finding = unsigned_speed_finding(plant, vehicle, gains, "");
  ASSERT_TRUE(finding);
  EXPECT_THAT(finding->message, ::testing::HasSubstr("at 3.96 m/s"));
  EXPECT_GT(backward_mps_after_1_s(plant, vehicle, gains, 3.9), 3.9);
  EXPECT_LT(backward_mps_after_1_s(plant, vehicle, gains, 4.1), 4.1);
  // A dead zone of 0.1 leaves the force 4 x 0.4: 3.2 m/s.
  plant.wheel_dead_zone = 0.1;
  finding = unsigned_speed_finding(plant, vehicle, gains, "");
  ASSERT_TRUE(finding);
  EXPECT_THAT(finding->message, ::testing::HasSubstr("at 3.17 m/s"));
  // Back-EMF reduces it by 4 x 0.1 u: 1.6 = (0.5 + 0.4) u at 1.78 m/s. The controller compensates
  // back-EMF for the wrong direction, which removes 0.8 u from the 2 u that it requests.
  plant.back_emf_s_per_m = 0.1;
  finding = unsigned_speed_finding(plant, vehicle, gains, "");
  ASSERT_TRUE(finding);
  EXPECT_THAT(finding->message, ::testing::HasSubstr("at 1.76 m/s"));
  EXPECT_GT(backward_mps_after_1_s(plant, vehicle, gains, 1.7), 1.7);
  EXPECT_LT(backward_mps_after_1_s(plant, vehicle, gains, 1.85), 1.85);
  // With k_e = 0.2, 1.6 u is removed. The remaining 0.4 u is below the resistance.
  plant.back_emf_s_per_m = 0.2;
  EXPECT_FALSE(unsigned_speed_finding(plant, vehicle, gains, ""));
  EXPECT_LT(backward_mps_after_1_s(plant, vehicle, gains, 0.5), 0.5);
  // Motors without backward force cannot drive the vehicle backward.
  plant.back_emf_s_per_m = 0.0;
  vehicle.wheel_force.lo = 0.0;
  EXPECT_FALSE(unsigned_speed_finding(plant, vehicle, gains, ""));
  EXPECT_LT(backward_mps_after_1_s(plant, vehicle, gains, 0.5), 0.5);
}

TEST(Validity, WarnsOfTyresThatContradictTheTurningTrials) {
  Model model = fitted_paper_model();
  Scenario on_tyres = kSteps;
  on_tyres.tyres = Tyres<double>{};
  EXPECT_FALSE(tyres_differ(on_tyres, model));  // the model has no measured yaw rate to compare at
  model.vehicle.yaw_rate_max_degps = 15.0;
  const auto finding = tyres_differ(on_tyres, model);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->code, "tyres-differ");
  EXPECT_FALSE(tyres_differ(kSteps, model));
}

}  // namespace
}  // namespace awmr::testing
