/// Tyre scrub in the 3-DOF plant: it acts in differential turns and not in steered ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/model/paper_gains.h"
#include "awmr/model/sliding.h"
#include "awmr/model/steady.h"
#include "awmr/simulate/batch.h"
#include "awmr/simulate/plant_sampler.h"
#include "simulate/paper_plant.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

constexpr double kScrub_m = 0.02;

Plant<double> scrubbing_plant() {
  Plant<double> plant = paper_plant();
  plant.yaw_scrub_m = kScrub_m;
  return plant;
}

State<double> turning(double r_radps, double steering_rad) {
  return {.x_m = 0.0,
          .y_m = 0.0,
          .psi_rad = 0.0,
          .u_mps = 1.0,
          .v_mps = 0.0,
          .r_radps = r_radps,
          .steering_rad = steering_rad};
}

/// Yaw moment of scrub over F_max, m: its effect on r_dot times I'z.
double scrub_at(const State<double>& state, const SideForces<double>& force) {
  const Plant<double> plant = scrubbing_plant();
  const FrictionWithScrub<double, SideForces<double>> friction{{0.0, 0.0}, plant, force};
  const State<double> free = state_rates(plant, state, force, 0.0);
  const State<double> braked =
      with_friction(friction.in(state), sliding(friction, state, free), free);
  return (free.r_radps - braked.r_radps) * plant.inertia_norm;
}

TEST(Scrub, OpposesTheTurnByTheDifferentialShareOfItsMoment) {
  // Tolerance: rounding of sums of moments of about 0.1 m, divided by I'z = 0.0128.
  constexpr double kRounding_m = 1e-14;
  EXPECT_NEAR(scrub_at(turning(0.2, 0.0), {0.2, 0.3}), kScrub_m, kRounding_m);
  EXPECT_NEAR(scrub_at(turning(-0.2, 0.0), {0.2, 0.3}), -kScrub_m, kRounding_m);
  // A differential moment that brakes the turn drags the wheels as well.
  EXPECT_NEAR(scrub_at(turning(0.2, 0.0), {0.3, 0.2}), kScrub_m, kRounding_m);
  EXPECT_NEAR(scrub_at(turning(0.2, 0.2), {0.3, 0.3}), 0.0, kRounding_m);
  EXPECT_NEAR(scrub_at(turning(0.2, 0.0), {0.0, 0.0}), 0.0, kRounding_m);
  const SideForces<double> force{0.2, 0.3};
  const auto tau =
      generalised_forces(paper_plant().front_axle_m, paper_plant().half_track_m, force, 0.2);
  const double share = tau.tau_diff_m / (tau.tau_diff_m + tau.tau_steering_m);
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.8);
  EXPECT_NEAR(scrub_at(turning(0.2, 0.2), force), share * kScrub_m, kRounding_m);
}

TEST(Scrub, OfASteadyDifferentialTurnIsWhatItsTrialMeasures) {
  // The steady turn satisfies the equation of identify, 2 d (F'R - F'L) = g3(r) + c. After 20 s, 50
  // time constants I'z/g3'(r) of at most 0.4 s, r is within 1e-6 of it.
  const Plant<double> plant = scrubbing_plant();
  const double tau_turn_m = 0.1;
  const awmr::Run run = run_open_loop(plant, turning(0.0, 0.0), 20.0, {1.0, tau_turn_m});
  const double r = run.rows.back().state.r_radps;
  EXPECT_NEAR(r, steady_rate(paper_plant().yaw, tau_turn_m - kScrub_m).value(), 1e-6 * r);
}

TEST(Scrub, HoldsAVehicleUnderASmallerMoment) {
  const awmr::Run run =
      run_open_loop(scrubbing_plant(), turning(0.0, 0.0), 5.0, {1.0, 0.5 * kScrub_m});
  EXPECT_EQ(run.rows.back().state.r_radps, 0.0);
  EXPECT_EQ(run.rows.back().state.psi_rad, 0.0);
}

TEST(Scrub, StopsATurningVehicleUnderASmallerMoment) {
  for (const double r_radps : {0.3, -0.3}) {
    const awmr::Run run =
        run_open_loop(scrubbing_plant(), turning(r_radps, 0.0), 5.0, {1.0, 0.5 * kScrub_m});
    // The moment of the resistances against the motion is at least c/2, so the vehicle stops
    // within 0.3 rad/s I'z/(c/2) = 0.4 s.
    for (const RunRow& row : run.rows) {
      if (row.t_s > 0.4) {
        EXPECT_EQ(row.state.r_radps, 0.0) << row.t_s;
      }
    }
  }
}

TEST(Scrub, HoldsNoVehicleThatTurnsByItsSteering) {
  const double tau_turn_m = 0.5 * kScrub_m;
  const awmr::Run run = run_open_loop(scrubbing_plant(), turning(0.0, 0.0), 20.0, {1.0, tau_turn_m},
                                      YawMode::kSteering);
  const double r = run.rows.back().state.r_radps;
  EXPECT_NEAR(r, steady_rate(paper_plant().yaw, tau_turn_m).value(), 1e-6 * r);
}

/// The motion with back-EMF, in which the moments, and with them the share q, depend on the speeds.
TEST(Scrub, IsTheSameWithShorterSteps) {
  Plant<double> plant = scrubbing_plant();
  plant.back_emf_s_per_m = 0.1;
  const auto controller = make_controller(plant, paper_vehicle(), kPaperGains);
  const Scenario scenario = short_heading();
  for (const YawMode mode : kYawModes) {
    const auto end = [&](std::optional<int> substeps) {
      const auto run = simulate(plant, controller, scenario, mode,
                                {.sample_time_s = 0.01, .substeps = substeps});
      return run.rows.back().state;
    };
    const State<double> coarse = end({});
    const State<double> fine = end(200);
    // A stop is found by linear interpolation within a step of 3 ms. Its error changes the yaw
    // rate by less than 1e-3 rad/s, and the heading law corrects the heading.
    EXPECT_NEAR(coarse.psi_rad, fine.psi_rad, 1e-4) << name_of(mode);
    EXPECT_NEAR(coarse.r_radps, fine.r_radps, 1e-3) << name_of(mode);
  }
}

TEST(Scrub, NeedsNoShorterSteps) {
  EXPECT_EQ(substeps_for(scrubbing_plant(), {}, 0.01), substeps_for(paper_plant(), {}, 0.01));
}

TEST(Scrub, WorksAgainstTheTurn) {
  // In the steady turn, tyre work grows by (g3(r) + c) r per second.
  const Plant<double> plant = scrubbing_plant();
  Scenario scenario = short_open_loop();
  scenario.guidance = OpenLoop{1.0, 0.1};
  const auto controller = make_controller(plant, paper_vehicle(), kPaperGains);
  const auto work_m = [&](double duration_s) {
    scenario.duration_s = duration_s;
    const awmr::Run run =
        simulate(plant, controller, scenario, YawMode::kDifferential, {.sample_time_s = 0.01});
    return metrics_of(run, scenario, controller).tyre_work;
  };
  const double r = steady_rate(plant.yaw, 0.1 - kScrub_m).value();
  EXPECT_NEAR(work_m(21.0) - work_m(20.0), 0.1 * r, 1e-6);
}

TEST(Scrub, IsTheSameInABatch) {
  const auto arithmetic = batch_arithmetic();
  ASSERT_TRUE(arithmetic);
  const Plant<double> plant = scrubbing_plant();
  const auto controller = make_controller(plant, paper_vehicle(), kPaperGains);
  const Scenario scenario = short_heading();
  for (const YawMode mode : kYawModes) {
    const std::vector<BatchRun> runs{{plant, controller, mode}};
    const auto batch = simulate_batch(runs, scenario, 0.01, *arithmetic);
    ASSERT_NE(batch.front().run.end, RunEnd::kFailed);
    const Metrics& metrics = batch.front().metrics;
    const Metrics alone = metrics_of(
        simulate(plant, controller, scenario, mode, {.sample_time_s = 0.01}), scenario, controller);
    // Tolerance: the run in a batch differs from simulate() only by rounding (batch_test.cpp).
    EXPECT_NEAR(*metrics.heading_iae_degs, *alone.heading_iae_degs, 1e-8);
    EXPECT_NEAR(metrics.tyre_work, alone.tyre_work, 1e-10);
  }
}

Model scrubbing_model(double moment_m) {
  Model model = uncertain_model();
  model.yaw_scrub = YawScrub{.moment_m = moment_m,
                             .std_error_m = 0.002,
                             .ci95_m = {moment_m - 0.005, moment_m + 0.005},
                             .rows = 6,
                             .yaw_rate_radps = {0.1, 0.3}};
  return model;
}

TEST(Scrub, OfTheModelIsInItsPlantAndNeverBelowZero) {
  EXPECT_EQ(scrubbing_model(0.01).plant()->yaw_scrub_m, 0.01);
  EXPECT_EQ(scrubbing_model(-0.001).plant()->yaw_scrub_m, 0.0);
  EXPECT_EQ(uncertain_model().plant()->yaw_scrub_m, 0.0);
}

TEST(Scrub, IsDrawnWithItsErrorAndLeavesOtherDrawsAsTheyAre) {
  const auto plain = PlantSampler::make(uncertain_model());
  const auto sampler = PlantSampler::make(scrubbing_model(0.01));
  ASSERT_TRUE(plain && sampler);
  constexpr int kSamples = 2000;
  double sum = 0.0, squares = 0.0;
  for (int i = 1; i <= kSamples; ++i) {
    const auto drawn = sampler->draw(5, i);
    ASSERT_TRUE(drawn);
    EXPECT_EQ(drawn->yaw.alpha, plain->draw(5, i)->yaw.alpha);
    sum += drawn->yaw_scrub_m;
    squares += drawn->yaw_scrub_m * drawn->yaw_scrub_m;
  }
  // The standard error of the mean of 2,000 draws is 0.002/sqrt(2000) = 4.5e-5, that of their
  // standard deviation 0.002/sqrt(4000) = 3.2e-5; 5 standard errors are allowed.
  const double mean = sum / kSamples;
  EXPECT_NEAR(mean, 0.01, 2.3e-4);
  EXPECT_NEAR(std::sqrt(squares / kSamples - mean * mean), 0.002, 1.6e-4);
  const auto evenly = sampler->draw_evenly(5, 16);
  const auto plainly = plain->draw_evenly(5, 16);
  ASSERT_TRUE(evenly && plainly);
  double even_sum = 0.0;
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ((*evenly)[i].mass_norm, (*plainly)[i].mass_norm);
    even_sum += (*evenly)[i].yaw_scrub_m;
  }
  // The 16 draws are stratified, so their mean is much closer to 0.01 than that of independent
  // draws.
  EXPECT_NEAR(even_sum / 16.0, 0.01, 0.002 / 4.0);
}

}  // namespace
}  // namespace awmr::testing
