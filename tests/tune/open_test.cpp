/// Tuning with the key `open`: gains for vehicles with unmodelled variation of mass and forces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/robust.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

UnmodelledVariation paper_grid() {
  return {.mass_factors = {1.0, 3.1}, .wheel_forces = {{-1.0, 1.0}, {0.0, 1.0}, {0.0, 0.5}}};
}

TEST(Open, IsTakenByTheDrawsInTurnAndNotByTheModelsOwn) {
  const Model model = paper_model();
  const Plant<double> own = model.plant().value();
  const auto vehicles = vehicles_of(model, 7, 1, paper_grid(), Spread::kRandom);
  ASSERT_TRUE(vehicles);
  ASSERT_EQ(vehicles->size(), 8U);
  const std::pair<double, Interval> expected[] = {{1.0, model.vehicle.wheel_force},
                                                  {1.0, {-1.0, 1.0}},
                                                  {3.1, {-1.0, 1.0}},
                                                  {1.0, {0.0, 1.0}},
                                                  {3.1, {0.0, 1.0}},
                                                  {1.0, {0.0, 0.5}},
                                                  {3.1, {0.0, 0.5}},
                                                  {1.0, {-1.0, 1.0}}};
  for (std::size_t i = 0; i < vehicles->size(); ++i) {
    const auto& [factor, force] = expected[i];
    const DrawnVehicle& vehicle = (*vehicles)[i];
    EXPECT_EQ(vehicle.plant.mass_norm, factor * own.mass_norm) << i;
    EXPECT_EQ(vehicle.plant.inertia_norm, factor * own.inertia_norm) << i;
    EXPECT_EQ(vehicle.plant.surge.alpha, own.surge.alpha) << i;
    EXPECT_EQ(vehicle.wheel_force.lo, force.lo) << i;
    EXPECT_EQ(vehicle.wheel_force.hi, force.hi) << i;
  }
}

TEST(Open, RunsClipAtTheForcesOfTheirVehicle) {
  const Model model = paper_model();
  Scenario turn;
  turn.name = "turn";
  turn.duration_s = 3.0;
  turn.speed_mps = 1.0;
  turn.guidance = HeadingSteps{{{0.0, radians(60.0)}}};
  const Plant<double> plant = model.plant().value();
  ObjectiveSetting setting{.vehicles = {{plant, model.vehicle.wheel_force}, {plant, {0.0, 0.5}}},
                           .vehicle = model.vehicle,
                           .weights = {},
                           .scenarios = {turn},
                           .arithmetic = batch_arithmetic().value()};
  const auto scores = run_all(setting, draw_noise(setting), std::span(&kPaperGains, 1)).front();
  Vehicle weak = model.vehicle;
  weak.wheel_force = {0.0, 0.5};
  const auto controller = make_controller(plant, weak, kPaperGains);
  const auto modes = yaw_modes(model.vehicle);
  for (std::size_t m = 0; m < modes.size(); ++m) {
    const awmr::Run run = simulate(
        plant, controller, turn, modes[m],
        {.sample_time_s = model.vehicle.sample_time_s, .substeps = {}, .seed = 0, .sample = 1});
    const Metrics expected = metrics_of(run, turn, controller);
    EXPECT_NEAR(scores[modes.size() + m].metrics.control_effort, expected.control_effort, 1e-9);
    EXPECT_NEAR(*scores[modes.size() + m].metrics.heading_iae_degs, *expected.heading_iae_degs,
                1e-6);
    if (modes[m] == YawMode::kSteering) continue;
    EXPECT_GT(scores[modes.size() + m].metrics.heading_iae_degs,
              scores[m].metrics.heading_iae_degs);
  }
}

TEST(Open, IsRemovedFromTheVehiclesThatTookIt) {
  const Model model = paper_model();
  const Plant<double> own = model.plant().value();
  const UnmodelledVariation masses{.mass_factors = paper_grid().mass_factors, .wheel_forces = {}};
  const UnmodelledVariation forces{.mass_factors = {}, .wheel_forces = paper_grid().wheel_forces};
  const auto with = vehicles_of(model, 7, 1, paper_grid(), Spread::kRandom).value();
  for (std::size_t i = 0; i < with.size(); ++i) {
    const DrawnVehicle of_own_mass = without(masses, with)[i];
    const DrawnVehicle of_own_force = without(forces, with)[i];
    EXPECT_NEAR(of_own_mass.plant.mass_norm, own.mass_norm, 1e-15) << i;
    EXPECT_NEAR(of_own_mass.plant.inertia_norm, own.inertia_norm, 1e-15) << i;
    EXPECT_EQ(of_own_mass.wheel_force.hi, with[i].wheel_force.hi) << i;
    EXPECT_EQ(of_own_force.plant.mass_norm, with[i].plant.mass_norm) << i;
    EXPECT_EQ(of_own_force.wheel_force.hi, model.vehicle.wheel_force.hi) << i;
  }
}

/// Options of a search in which the drawn vehicles are too weak to settle in the scenario.
TuneOptions options_with_weak_vehicles() {
  TuneOptions options;
  options.mode = YawMode::kDifferential;
  options.global_evaluations = 10;
  options.local_evaluations = 0;
  options.draws = 2;
  options.evaluation_draws = 2;
  options.open.wheel_forces = {{-0.002, 0.002}};
  return options;
}

TEST(Open, IsTheCauseIfRunsSettleWithoutIt) {
  const Model model = paper_model();
  TuneOptions options = options_with_weak_vehicles();
  const Result<Tuning> refused = tune(model, options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kRefused);
  EXPECT_THAT(to_text(refused.error()), HasSubstr("Without `open/wheel_forces`"));
  options.allows_unsettled = true;
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  ASSERT_FALSE(tuning->unsettled.empty());
  for (const UnsettledRuns& one : tuning->unsettled) {
    ASSERT_TRUE(one.variation);
    EXPECT_EQ(one.variation->key, "open/wheel_forces");
    EXPECT_EQ(one.variation->share_without, 1.0);
    EXPECT_FALSE(one.error || one.noise);
  }
}

TuneOptions short_search() {
  TuneOptions options;
  options.one_set = true;
  options.global_evaluations = 60;
  options.local_evaluations = 20;
  options.evaluation_draws = 0;
  options.draws = 2;
  options.open.mass_factors = {1.0, 3.1};
  return options;
}

TEST(Open, GainsSuitEveryVariationAndTheFileListsIt) {
  const Model model = paper_model();
  const TuneOptions options = short_search();
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  // Characteristic polynomial with the mass 3.1 times as large (q = 1/3.1), without the delays of
  // sampling and servo: s^2 + q (lambda + k) s + q lambda k, k = mu/epsilon.
  const double lambda = tuning->gains.heading.lambda;
  const double k = tuning->gains.heading.mu / tuning->gains.heading.epsilon;
  EXPECT_GT((lambda + k) / (2.0 * std::sqrt(3.1 * lambda * k)), 0.6);
  const std::string text =
      gains_text(*tuning, options, {.command = "tune", .options = {}, .inputs = {}});
  EXPECT_THAT(text, HasSubstr("\"mass_factors\""));
  EXPECT_THAT(text, HasSubstr("\"drawn_from\": \"unmodelled variation\""));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("wheel_forces")));
}

std::string refused(const TuneOptions& options) {
  const Result<Tuning> tuning = tune(paper_model(), options);
  return tuning ? "" : to_text(tuning.error());
}

TEST(Open, IsRefusedWhereTheDrawsDoNotTakeAllOfIt) {
  TuneOptions options = short_search();
  options.draws = 1;
  EXPECT_THAT(refused(options), HasSubstr("draws: 1 does not cover all 2 combinations"));
  options = short_search();
  options.evaluation_draws = 1;
  EXPECT_THAT(refused(options), HasSubstr("judged_draws: 1 does not cover"));
  options = short_search();
  options.nominal = true;
  EXPECT_THAT(refused(options), HasSubstr("`nominal` draws none"));
}

TEST(Open, RefusesVariationOutsideTheVehiclesRanges) {
  for (const double factor : {0.0, -1.0, 11.0, std::numeric_limits<double>::quiet_NaN()}) {
    TuneOptions options = short_search();
    options.open.mass_factors = {1.0, factor};
    EXPECT_THAT(refused(options), HasSubstr("mass factor")) << factor;
  }
  for (const Interval force : {Interval{0.5, 0.5}, Interval{-2.0, 1.0}, Interval{-1.0, 0.0}}) {
    TuneOptions options = short_search();
    options.open.wheel_forces = {force};
    EXPECT_THAT(refused(options), HasSubstr("wheel forces")) << force.lo;
  }
  TuneOptions options = short_search();
  options.open.mass_factors.assign(kMaxOpenValues + 1, 1.0);
  options.draws = 100;
  EXPECT_THAT(refused(options), HasSubstr("more than 20 values"));
}

}  // namespace
}  // namespace awmr::testing
