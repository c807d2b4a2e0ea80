/// Probabilistic goals: the excess of a run over its limits, the quantile of this excess that the
/// goal bounds, and the verdict on new draws.
#include "awmr/tune/goals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "awmr/core/statistics/binomial.h"
#include "support/uncertain_model.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

const Scenario kScenario = default_tuning_scenario(paper_model()).value();

ModeScore run_with(double settling_s, double overshoot_deg, YawMode mode = YawMode::kCombined) {
  ModeScore score{.scenario = kScenario.name, .mode = mode};
  score.metrics.settling_time_s = settling_s;
  score.metrics.overshoot_deg = overshoot_deg;
  return score;
}

TuningGoal quick_and_calm(double share = 0.95) {
  return {
      .at_most = {{"settling_time_s", 2.0}, {"overshoot_deg", 1.0}}, .share = share, .mode = {}};
}

TEST(Goal, HoldsInARunThatKeepsEveryLimit) {
  const TuningGoal goal = quick_and_calm();
  EXPECT_DOUBLE_EQ(excess_of(goal, outcome_of(run_with(1.0, 0.2), kScenario)), 0.5);
  EXPECT_DOUBLE_EQ(excess_of(goal, outcome_of(run_with(1.0, 3.0), kScenario)), 3.0);
  EXPECT_DOUBLE_EQ(excess_of(goal, outcome_of(run_with(2.0, 1.0), kScenario)), 1.0);
  ModeScore never = run_with(0.0, 0.0);
  never.metrics.settling_time_s.reset();
  EXPECT_DOUBLE_EQ(excess_of(goal, outcome_of(never, kScenario)), kScenario.duration_s / 2.0);
  never.metrics.overshoot_deg = std::nan("");
  EXPECT_TRUE(std::isinf(excess_of(goal, outcome_of(never, kScenario))));
}

TEST(Goal, IsEvaluatedByTheQuantileOfItsShare) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> seconds(0.5, 6.0);
  for (const int runs : {1, 2, 5, 19, 20, 21, 400}) {
    for (const double share : {0.5, 0.8, 0.95, 0.999}) {
      const TuningGoal goal = quick_and_calm(share);
      std::vector<ModeScore> scores;
      std::vector<double> excess;
      for (int i = 0; i < runs; ++i) {
        for (const YawMode mode : kYawModes) {
          scores.push_back(run_with(seconds(random), 0.0, mode));
          if (mode == YawMode::kSteering)
            excess.push_back(*scores.back().metrics.settling_time_s / 2.0);
        }
      }
      std::sort(excess.begin(), excess.end());
      const GoalInMode one{&goal, YawMode::kSteering};
      const double quantile = quantile_of_excess(one, outcomes_of(scores, {&kScenario, 1}), 1);
      const auto within = std::upper_bound(excess.begin(), excess.end(), quantile) - excess.begin();
      EXPECT_GE(double(within), share * runs - 1e-9) << runs << " " << share;
      EXPECT_LT(double(within - 1), share * runs) << runs << " " << share;
    }
  }
}

TEST(Goal, IsMetMissedOrOpenByTheExactIntervalOfItsShare) {
  const TuningGoal goal = quick_and_calm(0.9);
  const GoalInMode one{&goal, YawMode::kCombined};
  const auto evaluate = [&](int held, int runs) {
    std::vector<ModeScore> scores;
    for (int i = 0; i < runs; ++i) scores.push_back(run_with(i < held ? 1.0 : 3.0, 0.0));
    return evaluate_goal(one, {"robust", outcomes_of(scores, {&kScenario, 1})}, 1);
  };
  EXPECT_EQ(evaluate(400, 400).verdict, GoalVerdict::kMet);
  EXPECT_EQ(evaluate(300, 400).verdict, GoalVerdict::kMissed);
  EXPECT_EQ(evaluate(362, 400).verdict, GoalVerdict::kOpen);
  EXPECT_EQ(evaluate(5, 5).verdict, GoalVerdict::kOpen);  // too few runs to confirm a share of 90 %
  const EvaluatedGoal some = evaluate(362, 400);
  EXPECT_EQ(some.held, 362);
  EXPECT_EQ(some.runs, 400);
  EXPECT_EQ(some.ci95.lo, clopper_pearson(362, 400).lo);
}

TEST(Goal, OfADrawHoldsWhereAllItsScenariosKeepIt) {
  const TuningGoal goal = quick_and_calm(0.5);
  const GoalInMode one{&goal, YawMode::kCombined};
  const std::vector<Scenario> scenarios{kScenario, held_out_scenario(paper_model()).value()};
  // Two drawn vehicles; the first one fails in the second scenario.
  const std::vector<ModeScore> scores{run_with(1.0, 0.0), run_with(3.0, 0.0), run_with(1.0, 0.0),
                                      run_with(1.6, 0.0)};
  const EvaluatedGoal evaluated = evaluate_goal(one, {"robust", outcomes_of(scores, scenarios)}, 2);
  EXPECT_EQ(evaluated.runs, 2);
  EXPECT_EQ(evaluated.held, 1);
  EXPECT_DOUBLE_EQ(quantile_of_excess(one, outcomes_of(scores, scenarios), 2), 0.8);
}

TEST(Goal, IsMissedByARunThatBreaksOff) {
  ModeScore broken = run_with(0.5, 0.0);
  broken.has_failed = true;
  EXPECT_TRUE(std::isinf(excess_of(quick_and_calm(), outcome_of(broken, kScenario))));
}

TEST(Goal, IsForItsModeOrForEach) {
  std::vector<TuningGoal> goals{quick_and_calm(), quick_and_calm()};
  goals[1].mode = YawMode::kSteering;
  const auto all = by_mode(goals, kYawModes);
  ASSERT_EQ(all.size(), std::size(kYawModes) + 1);
  EXPECT_EQ(all.back().mode, YawMode::kSteering);
  EXPECT_THAT(all.back().name(), HasSubstr("settling_time_s <= 2, overshoot_deg <= 1 in 95 %"));
}

TuneOptions options_with(const TuningGoal& goal) {
  TuneOptions options;
  options.one_set = true;
  options.global_evaluations = 80;
  options.local_evaluations = 30;
  options.draws = 3;
  options.evaluation_draws = 60;
  options.goals = {goal};
  return options;
}

/// Settling time in differential mode that the goal's fraction of the fresh draws does not exceed.
double settled_s(const Tuning& tuning) {
  for (const EvaluatedGains& evaluated : tuning.robust->evaluated) {
    if (evaluated.gains != "robust" || evaluated.mode != YawMode::kDifferential) continue;
    for (const EvaluatedFigure& figure : evaluated.figures) {
      if (figure.name == "settling_time_s") return figure.q95;
    }
  }
  ADD_FAILURE();
  return 0.0;
}

TEST(Goal, ThatIsHardHoldsOnTheDrawsOfTheSearchAndMovesTheGains) {
  const Model model = uncertain_model();
  TuneOptions without = options_with({});
  without.goals.clear();
  const Result<Tuning> free = tune(model, without);
  ASSERT_TRUE(free) << to_text(free.error());
  // The goal requires 10 % less control variation than the gains found without a goal have.
  double activity = 0.0;
  for (const ModeScore& score : free->scores) {
    if (score.mode == YawMode::kDifferential) activity = score.metrics.control_variation;
  }
  TuningGoal goal{.at_most = {{"control_variation", 0.9 * activity}},
                  .mode = YawMode::kDifferential};
  const Result<Tuning> held = tune(model, options_with(goal));
  ASSERT_TRUE(held) << to_text(held.error());
  for (const ModeScore& score : held->scores) {
    if (score.mode != YawMode::kDifferential) continue;
    EXPECT_LE(score.metrics.control_variation, 0.9 * activity);
  }
  ASSERT_EQ(held->robust->goals.size(), 3U);  // robust, paper's and nominal gains
  EXPECT_EQ(held->robust->goals.front().gains, "robust");
  EXPECT_EQ(held->robust->goals.front().runs, 60);
  EXPECT_NE(held->gains.heading.lambda, free->gains.heading.lambda);
  EXPECT_GT(held->objective, 0.99 * free->objective) << "a limit cannot improve the objective";
}

TEST(Goal, ThatNoGainsReachIsRefusedByItsName) {
  TuneOptions options = options_with({.at_most = {{"settling_time_s", 0.05}}, .mode = {}});
  options.one_set = false;
  options.mode = YawMode::kDifferential;
  const Result<Tuning> tuning = tune(uncertain_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kRefused);
  EXPECT_THAT(to_text(tuning.error()), HasSubstr("reach the goal \"settling_time_s <= 0.05"));
  // A soft goal that cannot be met does not cause an error; its verdict is "missed".
  options.goals.front().is_soft = true;
  const Result<Tuning> tuned = tune(uncertain_model(), options);
  ASSERT_TRUE(tuned) << to_text(tuned.error());
  EXPECT_GT(settled_s(*tuned), 0.05);
  EXPECT_EQ(tuned->robust->goals.front().verdict, GoalVerdict::kMissed);
}

TEST(Goal, RefusesGoalsWithoutMeaning) {
  const auto why = [](TuneOptions options) {
    const Result<Tuning> tuning = tune(uncertain_model(), options);
    return tuning ? std::string("accepted") : to_text(tuning.error());
  };
  TuneOptions nominal = options_with(quick_and_calm());
  nominal.nominal = true;
  EXPECT_THAT(why(nominal), HasSubstr("which nominal disables"));
  TuneOptions steering = options_with(quick_and_calm());
  steering.goals.front().mode = YawMode::kSteering;
  Model unsteered = uncertain_model();
  unsteered.vehicle.drive = Drive::kDifferential;
  EXPECT_THAT(to_text(tune(unsteered, steering).error()), HasSubstr("has no mode steering"));
  TuneOptions unevaluated = options_with(quick_and_calm());
  unevaluated.evaluation_draws = 0;
  EXPECT_THAT(why(unevaluated), HasSubstr("judged_draws has to be above 0"));
  EXPECT_THAT(why(options_with(quick_and_calm(1.0))), HasSubstr("the share 1 "));
  EXPECT_THAT(why(options_with({})), HasSubstr("without a limit"));
  EXPECT_THAT(why(options_with({.at_most = {{"speed", 1.0}}, .mode = {}})),
              HasSubstr("unknown or given twice"));
  EXPECT_THAT(why(options_with({.at_most = {{"overshoot_deg", 0.0}}, .mode = {}})),
              HasSubstr("not above 0"));
}

}  // namespace
}  // namespace awmr::testing
