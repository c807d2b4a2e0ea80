/// Decisions: which modes stay first over changes of weights, plant and gains.
#include "awmr/compare/decision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "awmr/compare/overall.h"
#include "awmr/compare/scoring.h"
#include "awmr/core/json/json.h"
#include "awmr/core/random.h"
#include "awmr/model/gains_file.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Contender kDifferential{YawMode::kDifferential, ""};
const Contender kSteering{YawMode::kSteering, ""};
const Contender kCombined{YawMode::kCombined, ""};

/// Comparison with one run of each mode, whose scored metrics are random numbers around 1.
Comparison drawn(std::uint64_t number) {
  Comparison comparison;
  Random random(11, number);
  const auto metric = [&] { return std::exp(0.3 * random.normal()); };
  for (const YawMode mode : kYawModes) {
    ComparisonRow row{.scenario = "s", .mode = mode, .metrics = {}};
    row.metrics.completed = true;
    row.metrics.settling_time_s = 10.0 * metric();
    row.metrics.heading_iae_degs = 100.0 * metric();
    row.metrics.speed_drop_mps = metric();
    row.metrics.energy_mech = 10.0 * metric();
    row.metrics.tyre_work = metric();
    comparison.rows.push_back(row);
  }
  return comparison;
}

/// Modes of rank 1 that complete a run.
std::vector<Contender> first_with(const ScenarioRows& rows, const Preferences& preferences) {
  std::vector<Contender> first;
  for (const RankedMode& mode : rank(rows, statistics_of(rows, preferences, 1), preferences)) {
    if (mode.rank == 1 && mode.completed_share > 0.0) first.push_back(mode.contender);
  }
  return first;
}

/// Modes that are first for all 2^5 combinations of halved and doubled weights of the five scored
/// metrics. A score is linear-fractional in the weights, so its extremes over the box are at these
/// corners.
std::vector<Contender> first_at_every_corner(const ScenarioRows& rows) {
  std::vector<Contender> always{kDifferential, kSteering, kCombined};
  const std::vector<ScoredMetric> scoring = scoring_of(rows, {});
  for (unsigned corner = 0; corner < 1U << scoring.size(); ++corner) {
    Preferences preferences;
    for (std::size_t k = 0; k < scoring.size(); ++k) {
      preferences.weights[std::string(scoring[k].metric->name)] =
          (corner >> k & 1U) != 0 ? kWeightFactor : 1.0 / kWeightFactor;
    }
    const std::vector<Contender> first = first_with(rows, preferences);
    std::erase_if(always, [&](const Contender& one) {
      return std::find(first.begin(), first.end(), one) == first.end();
    });
  }
  return always;
}

TEST(Decision, OfWeightsIsThatOfAllCornersOfTheirRange) {
  std::size_t nobody = 0;
  for (std::uint64_t number = 0; number < 60; ++number) {
    const Comparison comparison = drawn(number);
    const ScenarioRows rows = group(comparison).front();
    const ScenarioStatistics statistics = statistics_of(rows, {}, 1);
    const Decision decision = decide(rows, statistics, rank(rows, statistics), {}, {}, 1);
    ASSERT_THAT(decision.changes, SizeIs(1));
    EXPECT_EQ(decision.changes[0].kind, ChangeKind::kWeights);
    EXPECT_THAT(decision.changes[0].first,
                ::testing::UnorderedElementsAreArray(first_at_every_corner(rows)))
        << number;
    nobody += decision.changes[0].first.empty() ? 1 : 0;
  }
  // Of the 60 random cases some have a mode that is first for all weights, and some have none.
  EXPECT_GT(nobody, 5U);
  EXPECT_LT(nobody, 55U);
}

Change on_tyres(std::vector<Contender> first) {
  return {.scenario = "s",
          .kind = ChangeKind::kPlant,
          .setting = "four-wheel",
          .first = std::move(first)};
}

TEST(Decision, NamesTheModeThatIsNeverBehind) {
  const Decision kept{{kDifferential}, {on_tyres({kDifferential, kCombined})}};
  EXPECT_EQ(kept.kind(), DecisionKind::kDecided);
  EXPECT_THAT(kept.never_behind(), ElementsAre(kDifferential));
  EXPECT_TRUE(kept.survives(kept.changes[0]));
  const Decision lost{{kDifferential}, {on_tyres({kCombined})}};
  EXPECT_EQ(lost.kind(), DecisionKind::kUndecided);
  EXPECT_FALSE(lost.survives(lost.changes[0]));
  const Decision level{{kSteering, kCombined}, {on_tyres({kCombined, kSteering})}};
  EXPECT_EQ(level.kind(), DecisionKind::kLevel);
}

TEST(Decision, NamesTheTrialThatDiscriminatesThePlants) {
  const Decision scrub{{kDifferential, kSteering}, {on_tyres({kSteering})}};
  EXPECT_THAT(scrub.deciding_trials(), ElementsAre(kDifferentialTurns));
  const Decision steered{{kDifferential, kSteering}, {on_tyres({kDifferential})}};
  EXPECT_THAT(steered.deciding_trials(), ElementsAre(kSteerWhileCoasting));
  const Decision both{{kDifferential}, {on_tyres({kSteering})}};
  EXPECT_THAT(both.deciding_trials(), ElementsAre(kDifferentialTurns, kSteerWhileCoasting));
  Change slower = on_tyres({kSteering});
  slower.kind = ChangeKind::kGains;
  EXPECT_THAT((Decision{{kDifferential}, {slower}}.deciding_trials()), IsEmpty());
}

Result<Comparison> compared(const std::vector<Scenario>& scenarios, int samples, int threads = 1) {
  return compare(uncertain_model(), kPaperGains, scenarios,
                 {.samples = samples, .seed = 3, .other_settings = true, .threads = threads});
}

TEST(Decision, ChangesAreRunsOnTheOtherPlantAndWithOtherGains) {
  const Scenario scenario = short_heading();
  const auto comparison = compared({scenario, short_open_loop()}, 3);
  ASSERT_TRUE(comparison) << to_text(comparison.error());
  ASSERT_THAT(comparison->changes,
              SizeIs(3));  // modes of the heading scenario only: open loop has no ranking
  Scenario tyres = scenario;
  tyres.tyres.emplace();
  Gains<double> slower = kPaperGains;
  slower.heading.lambda /= kGainsFactor;
  slower.heading.mu /= kGainsFactor;
  slower.speed.mu /= kGainsFactor;
  const CompareOptions options{.samples = 3, .seed = 3};
  const auto first = [&](const Scenario& course, const Gains<double>& gains) {
    const auto alone = compare(uncertain_model(), gains, {course}, options);
    EXPECT_TRUE(alone);
    return first_with(group(*alone).front(), {});
  };
  EXPECT_EQ(comparison->changes[0].setting, "four-wheel");
  EXPECT_EQ(comparison->changes[0].first, first(tyres, kPaperGains));
  EXPECT_EQ(comparison->changes[1].setting, "slower");
  EXPECT_EQ(comparison->changes[1].first, first(scenario, slower));
  EXPECT_EQ(comparison->changes[2].setting, "faster");
  const auto back = compared({tyres}, 0);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->changes[0].setting, "model");
}

TEST(Decision, DoesNotDependOnThreadsAndIsInTheFile) {
  const std::vector<Scenario> scenarios{short_heading("a"), short_heading("b")};
  const auto one = compared(scenarios, 2, 1);
  const auto many = compared(scenarios, 2, 3);
  ASSERT_TRUE(one && many);
  const CompareOptions options{.samples = 2, .seed = 3};
  const Provenance provenance{"compare", {}, {}};
  const std::string text = comparison_text(*one, options, provenance);
  EXPECT_EQ(text, comparison_text(*many, options, provenance));
  const Json json = Json::parse(text);
  const Json& decision = json.at("scenarios").at(0).at("decision");
  EXPECT_EQ(decision.at("changes").size(), 4U);  // weights, plant, slower gains, faster gains
  const Json& counts = json.at("decisions");
  // Both entries have the same runs, so they count as one scenario.
  EXPECT_EQ(counts.at("decided").get<int>() + counts.at("level").get<int>() +
                counts.at("undecided").get<int>(),
            1);
  EXPECT_EQ(counts.at("survived").at("gains").at("of"), 1);
}

TEST(Decision, NeedsTwoModes) {
  Model skid = uncertain_model();
  skid.vehicle.drive = Drive::kDifferential;
  const auto comparison = compare(skid, kPaperGains, {short_heading()}, {.other_settings = true});
  ASSERT_TRUE(comparison) << to_text(comparison.error());
  EXPECT_THAT(comparison->changes, IsEmpty());
  EXPECT_FALSE(evaluate_scenarios(*comparison, {}, 1).front().decision);
}

TEST(Decision, ReportsSettingsThatCouldNotBeRun) {
  Scenario slippery = short_heading();
  slippery.patches.push_back({.centre_m = {5.0, 0.0}, .radius_m = 1.0, .force_max = 0.1});
  const auto comparison = compared({slippery}, 0);
  ASSERT_TRUE(comparison) << to_text(comparison.error());
  ASSERT_FALSE(comparison->changes.empty());
  EXPECT_EQ(comparison->changes[0].kind, ChangeKind::kPlant);
  EXPECT_THAT(comparison->changes[0].not_run, ::testing::StartsWith("/slippery: "));
  EXPECT_THAT(comparison->changes[0].first, IsEmpty());
}

TEST(Decision, AnUndecidedLeadIsNotCalledBest) {
  Comparison comparison;
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering}) {
    ComparisonRow row{.scenario = "s", .mode = mode, .metrics = {}};
    row.metrics.completed = true;
    row.metrics.settling_time_s = mode == YawMode::kSteering ? 30.0 : 3.0;
    row.metrics.heading_iae_degs = 50.0;
    comparison.rows.push_back(row);
  }
  comparison.whole_samples = 1;
  const auto verdict = [&] { return evaluate_scenarios(comparison, {}, 1).front().verdict; };
  EXPECT_THAT(verdict(), ::testing::StartsWith("differential is best"));
  comparison.changes = {on_tyres({kSteering})};
  EXPECT_EQ(evaluate_scenarios(comparison, {}, 1).front().decision->kind(),
            DecisionKind::kUndecided);
  EXPECT_THAT(verdict(), ::testing::StartsWith("differential is ahead here"));
  EXPECT_THAT(verdict(), ::testing::HasSubstr("undecided: steering first on the four-wheel plant"));
}

TEST(Decision, NamesTheRuleThatPrefersOneOfTiedModes) {
  Comparison comparison;
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering}) {
    ComparisonRow row{.scenario = "s", .mode = mode, .metrics = {}};
    row.metrics.completed = true;
    row.metrics.settling_time_s = 3.0;
    row.metrics.heading_iae_degs = 50.0;
    comparison.rows.push_back(row);
  }
  comparison.whole_samples = 1;
  const auto one = [&] { return evaluate_scenarios(comparison, {}, 1).front(); };
  EXPECT_EQ(one().ranking.front().tied_with.size(), 1U);
  EXPECT_EQ(one().decision->kind(), DecisionKind::kLevel);
  EXPECT_THAT(one().verdict, ::testing::Not(::testing::HasSubstr("is preferred")));
  comparison.changes = {on_tyres({kSteering})};
  EXPECT_EQ(one().decision->kind(), DecisionKind::kDecided);
  EXPECT_THAT(one().decision->never_behind(), ElementsAre(kSteering));
  EXPECT_THAT(one().verdict, ::testing::HasSubstr("differential and steering are tied"));
  EXPECT_THAT(one().verdict,
              ::testing::HasSubstr("steering is preferred, because only steering keeps a first "
                                   "place"));
}

/// Comparison of differential and steering: one run each, with these settling times, s, and tyre
/// works, m, of steering. Those of differential are 10 s and 0.2 m.
Comparison by_two_metrics(double settling_time_s, double tyre_work) {
  Comparison comparison;
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering}) {
    const bool steers = mode == YawMode::kSteering;
    ComparisonRow row{.scenario = "s", .mode = mode, .metrics = {}};
    row.metrics.completed = true;
    row.metrics.settling_time_s = steers ? settling_time_s : 10.0;
    row.metrics.heading_iae_degs = 50.0;
    row.metrics.tyre_work = steers ? tyre_work : 0.2;
    comparison.rows.push_back(row);
  }
  comparison.whole_samples = 1;
  return comparison;
}

TEST(Decision, IsUndecidedIfOneMetricAloneLeadsNarrowly) {
  // Four metrics are ranked: those above and the mechanical work, which is 0. With the offsets 0.2 m
  // and 2 s, the score of steering is ((0.35 + 0.2)/(0.2 + 0.2) (9.2 + 2)/(10 + 2))^(1/4) = 1.064.
  // With half the weight of the tyre work, it is (1.375^0.5 0.933)^(1/3.5) = 1.026: tied.
  const Comparison narrow = by_two_metrics(9.2, 0.35);
  const EvaluatedScenario one = evaluate_scenarios(narrow, {}, 1).front();
  ASSERT_TRUE(one.decision->narrow_lead);
  EXPECT_EQ(one.decision->narrow_lead->metric->name, "tyre_work");
  EXPECT_THAT(one.decision->narrow_lead->others, ElementsAre(kSteering));
  EXPECT_EQ(one.decision->kind(), DecisionKind::kUndecided);
  EXPECT_THAT(one.verdict, ::testing::StartsWith("differential is ahead here"));
  EXPECT_THAT(one.verdict, ::testing::HasSubstr("differential leads steering only by tyre_work"));
  const Json json = Json::parse(comparison_text(narrow, {}, {"compare", {}, {}}));
  EXPECT_EQ(json.at("scenarios").at(0).at("decision").at("narrow_lead").at("metric"), "tyre_work");
  const auto kind = [](const Comparison& comparison) {
    return evaluate_scenarios(comparison, {}, 1).front().decision->kind();
  };
  // A larger lead in the same metric, (3^0.5 0.933)^(1/3.5) = 1.15 with half its weight, decides.
  EXPECT_EQ(kind(by_two_metrics(9.2, 1.0)), DecisionKind::kDecided);
  // So do a lead in two metrics, and a lead without a disadvantage in another metric.
  EXPECT_EQ(kind(by_two_metrics(13.0, 0.35)), DecisionKind::kDecided);
  EXPECT_EQ(kind(by_two_metrics(10.0, 0.35)), DecisionKind::kDecided);
}

TEST(Decision, NamesTheModeThatCompletesNoRunOfAChange) {
  Comparison comparison = drawn(1);
  comparison.whole_samples = 1;
  comparison.changes = {on_tyres({kSteering, kCombined})};
  comparison.changes[0].completed = {{kDifferential, 0, 1}, {kSteering, 1, 1}, {kCombined, 1, 1}};
  EXPECT_THAT(evaluate_scenarios(comparison, {}, 1).front().verdict,
              ::testing::HasSubstr("; differential completed 0 of 1 on the four-wheel plant"));
  comparison.changes[0].completed[0].count = 1;
  EXPECT_THAT(evaluate_scenarios(comparison, {}, 1).front().verdict,
              ::testing::Not(::testing::HasSubstr("completed 0 of")));
}

TEST(Decision, CountsTheCompletedRunsOfEachMode) {
  const auto comparison = compared({short_heading()}, 0);
  ASSERT_TRUE(comparison) << to_text(comparison.error());
  ASSERT_FALSE(comparison->changes.empty());
  for (const Change& change : comparison->changes) {
    ASSERT_THAT(change.completed, SizeIs(3));
    for (const Completion& one : change.completed) EXPECT_EQ(one.of, 1U);
  }
}

}  // namespace
}  // namespace awmr::testing
