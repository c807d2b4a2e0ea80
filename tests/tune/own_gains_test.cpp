/// Gains of its own for each mode, if one mode holds the others back.
#include "awmr/tune/tuning_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "awmr/simulate/metrics.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/tune_findings.h"
#include "tune/vehicles.h"

namespace awmr::testing {
namespace {

/// The servo of this truck is slow, so that gains for all modes make the differential mode slow.
Model truck_with_a_slow_servo() {
  return model_of({.name = "600 kg truck",
                   .mass_kg = 600.0,
                   .length_m = 4.4,
                   .width_m = 1.76,
                   .front_axle_m = 1.1,
                   .half_track_m = 0.8,
                   .steering_max_deg = 28,
                   .steering_rate_degps = 40,
                   .servo_s = 0.35,
                   .sample_time_s = 0.05,
                   .motor_force_n = 2000.0,
                   .surge = {.alpha = 0.35, .beta = 0.9},
                   .yaw = {.alpha = 0.9, .beta = 0.9},
                   .sway_alpha = 3.0,
                   .measured_mps = 0.0,
                   .measured_degps = 0.0});
}

/// Gains as in a file with gains by mode.
ModeGains gains_by_mode() {
  ModeGains gains(Gains<double>{{1.0, 5.0, 2.0}, {1.0, 0.5}});
  gains.set(YawMode::kSteering, {{0.5, 3.0, 2.0}, {1.0, 0.5}});
  return gains;
}

TEST(OwnGains, AreComparedWithTheBaselineOfEachMode) {
  const Model model = truck_with_a_slow_servo();
  TuneOptions options;
  options.nominal = true;
  options.baseline = Baseline{gains_by_mode(), "before.json"};
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  ASSERT_EQ(tuning->own.size(), 2U);
  for (const Tuning& one : tuning->own) {
    const Gains<double> expected = gains_by_mode().in(*one.mode);
    EXPECT_EQ(one.baseline.gains.common().heading.lambda, expected.heading.lambda)
        << name_of(*one.mode);
    // The baseline's own scores are 1, those of the tuned gains are relative to them.
    for (std::size_t i = 0; i < one.scores.size(); ++i) {
      EXPECT_NEAR(one.baseline_scores[i].objective, 1.0, 1e-12);
      EXPECT_NEAR(one.scores[i].objective,
                  objective_of(one.scores[i], one.baseline_scores[i], options.weights), 1e-12);
    }
  }
}

std::size_t count(const std::vector<Finding>& findings, std::string_view code) {
  return static_cast<std::size_t>(std::ranges::count(findings, code, &Finding::code));
}

/// Overshoot, which no gains have, outweighs the settling time, so that the objective of gains that
/// settle much faster is hardly lower.
TEST(OwnGains, AreUsedIfTheySettleMuchFasterWithAnObjectiveThatIsHardlyLower) {
  const Model model = truck_with_a_slow_servo();
  TuneOptions options;
  options.nominal = true;
  options.weights.overshoot = 30.0;
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  ASSERT_EQ(tuning->own.size(), 2U);
  EXPECT_EQ(tuning->own.front().mode, YawMode::kDifferential);
  EXPECT_GT(tuning->own.front().gains.heading.lambda,
            1.2 * tuning->own.back().gains.heading.lambda);
}

/// Without these bounds, the search finds gains for two modes (OfEachModeSettleASlowServosOtherModesFaster).
TEST(OwnGains, AreNeitherSearchedNorRecommendedOutsideOfTheBounds) {
  const Model model = truck_with_a_slow_servo();
  TuneOptions options;
  options.nominal = true;
  options.scenarios = default_tuning_scenarios(model, options).value();
  options.bounds.lambda = Interval{0.3, 0.3};
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_TRUE(tuning->own.empty());
  EXPECT_EQ(count(tune_findings(model, options, *tuning), "faster-in-one-mode"), 0U);
}

/// Expects that gains of one mode do not hide that another mode could be faster.
void expect_faster_mode_is_reported(const Model& model, TuneOptions options, Tuning tuning) {
  options.scenarios = default_tuning_scenarios(model, options).value();
  EXPECT_EQ(count(tune_findings(model, options, tuning), "faster-in-one-mode"), 0U);
  tuning.own.back().alone.push_back(
      {.mode = YawMode::kSteering, .settling_time_s = 3.0, .tuned_settling_time_s = 5.0});
  const std::vector<Finding> findings = tune_findings(model, options, tuning);
  EXPECT_EQ(count(findings, "gains-by-mode"), 1U);
  EXPECT_EQ(count(findings, "faster-in-one-mode"), 1U);
}

TEST(OwnGains, OfEachModeSettleASlowServosOtherModesFaster) {
  const Model model = truck_with_a_slow_servo();
  TuneOptions options;
  options.nominal = true;
  const Result<Tuning> apart = tune(model, options);
  ASSERT_TRUE(apart) << to_text(apart.error());
  ASSERT_EQ(apart->own.size(), 2U);
  expect_faster_mode_is_reported(model, options, *apart);
  options.one_set = true;
  const Result<Tuning> common = tune(model, options);
  ASSERT_TRUE(common) << to_text(common.error());
  EXPECT_TRUE(common->own.empty());
  EXPECT_FALSE(common->alone.empty());
  EXPECT_EQ(apart->mode, YawMode::kCombined);
  EXPECT_EQ(apart->certificate->modes.size(), 3U);
  // In a nominal search, the objective is the geometric mean over the scenarios.
  for (const Tuning& one : apart->own) {
    double log_objective = 0.0;
    for (const ModeScore& score : one.scores) log_objective += std::log(score.objective);
    EXPECT_NEAR(std::log(one.objective), log_objective / static_cast<double>(one.scores.size()),
                1e-12)
        << name_of(*one.mode);
  }
  const ModeGains gains = apart->mode_gains();
  const Scenario scenario = default_tuning_scenario(model).value();
  for (const YawMode mode : kYawModes) {
    const auto settling_s = [&](const Gains<double>& used) {
      const awmr::Run run = simulate(model, used, scenario, mode).value();
      return metrics_of(run, scenario, controller_for(model, used).value()).settling_time_s;
    };
    const auto own_s = settling_s(gains.in(mode)), common_s = settling_s(common->gains);
    ASSERT_TRUE(own_s && common_s) << name_of(mode);
    EXPECT_LT(*own_s, (mode == YawMode::kSteering ? 1.2 : 0.8) * *common_s) << name_of(mode);
    // Steering cannot be faster, so it keeps the common gains. The others are tuned alone.
    options.one_set = false;
    options.mode = mode;
    const Gains<double> expected =
        mode == YawMode::kSteering ? common->gains : tune(model, options)->gains;
    EXPECT_EQ(gains.in(mode).heading.lambda, expected.heading.lambda) << name_of(mode);
    EXPECT_EQ(gains.in(mode).speed.mu, expected.speed.mu) << name_of(mode);
  }
}

}  // namespace
}  // namespace awmr::testing
