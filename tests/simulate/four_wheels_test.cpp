/// Runs on four tyres: agreement with the model's plant, and general properties.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "awmr/model/paper_gains.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/run_file.h"
#include "simulate/energy.h"
#include "simulate/paper_plant.h"
#include "support/any_robot.h"

namespace awmr::testing {
namespace {

Scenario on_tyres(Scenario scenario, const Tyres<double>& tyres = {}) {
  scenario.tyres = tyres;
  return scenario;
}

Scenario open_loop(double tau_speed, double tau_turn_m, double duration_s) {
  return {.name = "open loop",
          .duration_s = duration_s,
          .initial = {},
          .speed_mps = 0.0,
          .guidance = OpenLoop{tau_speed, tau_turn_m}};
}

awmr::Run driven(const Scenario& scenario, YawMode mode, const SimulateOptions& options = {}) {
  const Plant<double> plant = paper_plant();
  return simulate(plant, make_controller(plant, paper_vehicle(), kPaperGains), scenario, mode,
                  options);
}

TEST(FourWheelRuns, ReachTheSpeedOfTheModelStraightAhead) {
  const Scenario scenario = open_loop(1.4, 0.0, 10.0);
  const State<double> model = driven(scenario, YawMode::kDifferential).rows.back().state;
  const State<double> wheels = driven(on_tyres(scenario), YawMode::kDifferential).rows.back().state;
  EXPECT_NEAR(wheels.u_mps, model.u_mps, 1e-9);
  EXPECT_EQ(wheels.y_m, 0.0);
  // The vehicle on tyres is slower, because friction limits its acceleration to mu g.
  EXPECT_LT(wheels.x_m, model.x_m);
}

TEST(FourWheelRuns, NeverAcceleratesFasterThanTheFrictionLets) {
  for (const double friction : {0.2, 0.8}) {
    const awmr::Run run =
        driven(on_tyres(open_loop(4.0, 0.0, 0.3), {.friction = friction}), YawMode::kDifferential);
    for (std::size_t i = 1; i < run.rows.size(); ++i) {
      const double accel = (run.rows[i].state.u_mps - run.rows[i - 1].state.u_mps) / 0.01;
      EXPECT_LE(accel, friction * 9.80665 * (1.0 + 1e-9));
    }
    EXPECT_NEAR(run.rows[1].state.u_mps / 0.01, friction * 9.80665, 1e-6);
  }
}

/// Stiff tyres at walking pace roll where they point: r = u tan(d)/(2 l_f) in radians, because the
/// rear wheels do not slide. With a stiffness of a hundred per radian about 3 % of sliding remains.
TEST(FourWheelRuns, StiffTyresTurnAsTheWheelsPoint) {
  Scenario scenario = on_tyres(open_loop(0.6, 0.01, 20.0), {.cornering_per_rad = 100.0});
  const RunRow last = driven(scenario, YawMode::kSteering).rows.back();
  ASSERT_GT(last.state.steering_rad, 0.02);
  const double expected = last.state.u_mps * std::tan(last.state.steering_rad) / (2.0 * 0.35);
  EXPECT_NEAR(last.state.r_radps, expected, 0.03 * expected);
}

/// Power of the wheels along their rolling direction minus tyre losses, over F_max.
double net_power(const FourWheels<double>& vehicle, const RunRow& now, const RunRow& commanded) {
  const Plant<double>& p = vehicle.body;
  const WheelForces<double> force = by_wheel(p.rear_driven, commanded.force);
  const WheelForces<double> x = tyre_forces(vehicle, now.state, force).along;
  const WheelSpeeds<double> w = wheel_speeds(p.front_axle_m, p.half_track_m, now.state);
  return x.front_left * w.front_left + x.front_right * w.front_right + x.rear_left * w.rear_left +
         x.rear_right * w.rear_right - tyre_power_mps(vehicle, now.state, force);
}

RC_GTEST_PROP(FourWheelRuns, WorkDoneIsKineticEnergyPlusWhatTheTyresTake, ()) {
  Scenario scenario = open_loop(between(0.3, 2.0), between(-0.2, 0.2), 1.0);
  scenario.initial.u_mps = between(0.2, 1.5);
  scenario.initial.v_mps = between(-0.3, 0.3);
  scenario.initial.r_radps = between(-1.0, 1.0);
  scenario.tyres = {between(0.2, 1.2), between(5.0, 15.0), 0.1};
  constexpr double kStep_s = 1e-4;
  const awmr::Run run =
      driven(scenario, YawMode::kCombined, {.sample_time_s = kStep_s, .substeps = 1});
  RC_ASSERT(run.end == RunEnd::kDuration);
  const FourWheels<double> vehicle{resolved_at_rest(paper_plant(), scenario, kStep_s),
                                   *scenario.tyres};
  double balance = 0.0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    balance += 0.5 * kStep_s *
               (net_power(vehicle, run.rows[i - 1], run.rows[i - 1]) +
                net_power(vehicle, run.rows[i], run.rows[i - 1]));
  }
  const double gained =
      kinetic(vehicle.body, run.rows.back().state) - kinetic(vehicle.body, run.rows.front().state);
  // Error of the trapezoidal rule with rates up to 1000 1/s (c_a g/v_0 and more) and steps of 1e-4
  // s: (0.1)^2/12 of the energy of the lateral motion, about 0.1, which decays within milliseconds.
  RC_ASSERT(std::abs(gained - balance) < 2e-4);
}

TEST(FourWheelRuns, MetersTheWorkOfTheTyres) {
  const Plant<double> plant = paper_plant();
  const Controller<double> controller = make_controller(plant, paper_vehicle(), kPaperGains);
  const Scenario scenario = on_tyres(heading_steps({30.0, -30.0}));
  const awmr::Run run = driven(scenario, YawMode::kDifferential);
  double work = 0.0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    work += (run.rows[i].t_s - run.rows[i - 1].t_s) * run.rows[i - 1].tyre_power_mps;
  }
  EXPECT_GT(work, 0.0);
  EXPECT_NEAR(metrics_of(run, scenario, controller).tyre_work, work, 1e-12);
}

/// With ten times shorter integration steps, the heading differs by less than a hundredth of a
/// degree.
TEST(FourWheelRuns, DoNotDependOnTheStep) {
  for (const YawMode mode : kYawModes) {
    for (const double tau_turn_m : {0.02, 0.1, 0.2}) {
      const Scenario scenario = on_tyres(open_loop(1.4, tau_turn_m, 5.0));
      const awmr::Run run = driven(scenario, mode);
      const awmr::Run finer = driven(scenario, mode, {.substeps = 10 * run.substeps});
      const State<double>& a = run.rows.back().state;
      const State<double>& b = finer.rows.back().state;
      const std::string where = std::string(name_of(mode)) + " " + std::to_string(tau_turn_m);
      EXPECT_NEAR(a.psi_rad, b.psi_rad, 2e-4) << where;
      EXPECT_NEAR(a.x_m, b.x_m, 2e-4) << where;
      EXPECT_NEAR(a.y_m, b.y_m, 2e-4) << where;
    }
  }
}

TEST(FourWheelRuns, KeepTheModelsPlantAsItWas) {
  const Scenario scenario = heading_steps({30.0});
  const Plant<double> plant = paper_plant();
  EXPECT_EQ(substeps_for(plant, scenario, 0.01), substeps_for(plant, {}, 0.01));
  EXPECT_EQ(plant_text(scenario), "model");
  EXPECT_EQ(run_csv(driven(scenario, YawMode::kCombined), scenario).find("tyre"),
            std::string::npos);
  const Scenario tyred = on_tyres(scenario);
  EXPECT_NE(run_csv(driven(tyred, YawMode::kCombined), tyred).find(",tyre_power_mps\n"),
            std::string::npos);
}

TEST(FourWheelRuns, WhatHasNoMeaningOnTyresIsNamed) {
  Scenario scenario = heading_steps({30.0});
  EXPECT_TRUE(tyre_conflicts(scenario).empty());
  scenario.patches = {{.centre_m = {}, .radius_m = 1.0, .force_max = 0.1}};
  scenario.corner = {{ParameterId::kYawAlpha, true}, {ParameterId::kMassNorm, true}};
  const auto conflicts = tyre_conflicts(scenario);
  ASSERT_EQ(conflicts.size(), 2U);
  EXPECT_TRUE(check_tyres(scenario));
  EXPECT_FALSE(check_tyres(on_tyres(scenario)));
  scenario.corner.clear();
  EXPECT_TRUE(plant_for(scenario, fitted_paper_model()));
  EXPECT_FALSE(plant_for(on_tyres(scenario), fitted_paper_model()));
  EXPECT_EQ(conflicts[0].key, "slippery");
  EXPECT_EQ(conflicts[1].key, "corner");
  EXPECT_NE(conflicts[1].message.find("yaw.alpha"), std::string::npos);
}

TEST(FourWheelRuns, AFailureNamesTheTyres) {
  const Scenario scenario = on_tyres(heading_steps({30.0}));
  awmr::Run run;
  run.rows.emplace_back();
  run.end = RunEnd::kFailed;
  const Status status = failure_of(run, scenario);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().faults.front().message.find("cornering stiffness"), std::string::npos);
}

}  // namespace
}  // namespace awmr::testing
