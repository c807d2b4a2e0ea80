/// Text of the verdict, and the count over all scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/compare/overall.h"
#include "awmr/compare/ranking.h"
#include "awmr/core/random.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// Comparison of 20 samples. Steering settles `behind_s` later than differential on average, with
/// the standard deviation `spread_s`, and fails in the first `failures` samples.
Comparison twenty(double behind_s, double spread_s, int failures = 0) {
  Comparison c;
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering}) {
    for (int i = 0; i <= 20; ++i) {
      Random random(5, static_cast<std::uint64_t>(i));
      ComparisonRow row{.scenario = "s", .mode = mode, .sample = i, .metrics = {}};
      const double common_s = 10.0 + random.normal();
      const double extra_s = behind_s + spread_s * random.normal();
      row.metrics.settling_time_s = common_s + (mode == YawMode::kSteering ? extra_s : 0.0);
      row.metrics.heading_iae_degs = 50.0;
      row.metrics.completed = mode == YawMode::kDifferential || i > failures;
      c.rows.push_back(row);
    }
  }
  return c;
}

struct Evaluated {
  Comparison comparison;  // keeps the rows alive, to which the ranking refers
  EvaluatedScenario scenario;
};

Evaluated evaluate(const Comparison& c) {
  Evaluated j{c, {}};
  j.scenario = evaluate_scenarios(j.comparison, {}, 1).front();
  return j;
}

std::string verdict(const Comparison& c) { return evaluate(c).scenario.verdict; }

TEST(Verdict, NamesTheBestAndTheLargestDifference) {
  const std::string text = verdict(twenty(3.0, 0.1));
  EXPECT_THAT(text, HasSubstr("differential is best; steering is behind"));
  EXPECT_THAT(text, HasSubstr("settling_time_s: 3"));
  EXPECT_THAT(text, HasSubstr("95 %"));
  EXPECT_THAT(text, HasSubstr("all completed"));
}

TEST(Verdict, GivesTheDifferenceOfTheOtherInEitherOrder) {
  for (const double behind_s : {3.0, -3.0}) {
    const std::string text = verdict(twenty(behind_s, 0.1));
    EXPECT_THAT(text, HasSubstr(behind_s > 0.0 ? "steering is behind" : "differential is behind"));
    EXPECT_THAT(text, ::testing::ContainsRegex(
                          "settling_time_s: [23][0-9.]* s more \\(95 %: 2[0-9.]* to 3"));
  }
}

TEST(Verdict, ReportsATie) {
  // The mean difference is 0.1 s with a standard error of 7/sqrt(20) = 1.6 s, that is, 16 % of 10
  // s, in one of four metrics.
  EXPECT_THAT(verdict(twenty(0.1, 7.0)), HasSubstr("is undecided, behind by"));
  // The difference is 0.4 s with a standard error of 0.02 s: significant, but less than 5 % of 10
  // s.
  EXPECT_THAT(verdict(twenty(0.4, 0.1)),
              HasSubstr("are tied: equivalent within 5 %; all completed"));
}

TEST(Verdict, NamesRelevantMetricsOfTiedModes) {
  // Steering settles 1 s later, 10 % of 10 s: relevant in this metric. It is one of four ranked
  // metrics, with an offset of 2 s, so that the score differs by ln(13/12)/4 = 2 %.
  Comparison c = twenty(1.0, 0.1);
  const Evaluated tied = evaluate(c);
  EXPECT_EQ(tied.scenario.ranking[1].towards_leader, Conclusion::kEquivalent);
  EXPECT_THAT(tied.scenario.verdict, HasSubstr("are tied: equivalent within 5 %"));
  EXPECT_THAT(tied.scenario.verdict,
              ::testing::ContainsRegex("relevant single metrics: steering [01][0-9.]* s more "
                                       "settling_time_s than differential"));
  EXPECT_THAT(verdict(twenty(0.4, 0.1)), Not(HasSubstr("relevant single metrics")));
}

TEST(Verdict, StatesThatScoresIncludeFailures) {
  EXPECT_THAT(verdict(twenty(0.0, 0.0, 10)),
              HasSubstr("scores include runs that were not completed"));
  EXPECT_THAT(verdict(twenty(0.0, 0.0)), Not(HasSubstr("scores include")));
}

TEST(Verdict, RanksAModeThatNeverCompletesBehindOneThatRarelyDoes) {
  // Differential completes 3 of 8 runs: McNemar's p is 0.25. Steering completes none, with shorter
  // settling times.
  Comparison c = twenty(-3.0, 0.1, 20);
  std::erase_if(c.rows, [](const ComparisonRow& row) { return row.sample > 8; });
  for (ComparisonRow& row : c.rows) {
    row.metrics.completed = row.mode == YawMode::kDifferential && row.sample < 4;
  }
  const Evaluated few = evaluate(c);
  EXPECT_EQ(few.scenario.ranking[0].contender.mode, YawMode::kDifferential);
  EXPECT_EQ(few.scenario.ranking[1].rank, 2);
  EXPECT_EQ(few.scenario.ranking[1].towards_leader, Conclusion::kRelevant);
  EXPECT_EQ(few.scenario.decision->kind(), DecisionKind::kDecided);
  for (const MetricTally& one : tally({few.scenario})) {
    EXPECT_THAT(one.best_or_tied, ElementsAre(1, 0));
  }
  // If no mode completes a run, no mode is recommended.
  for (ComparisonRow& row : c.rows) row.metrics.completed = false;
  const Evaluated none = evaluate(c);
  EXPECT_THAT(none.scenario.decision->first, ::testing::IsEmpty());
  EXPECT_EQ(none.scenario.decision->kind(), DecisionKind::kUndecided);
}

TEST(Verdict, TableStatesTheRunsOfAMeanThatNotAllRunsHave) {
  Comparison c = twenty(3.0, 0.1);
  c.whole_samples = 21;
  for (ComparisonRow& row : c.rows) {
    if (row.mode == YawMode::kSteering && row.sample > 5) row.metrics.settling_time_s.reset();
  }
  EXPECT_THAT(comparison_table(c), HasSubstr("settle: mean of some runs: steering 5 of 20\n"));
  EXPECT_THAT(comparison_table(c), Not(HasSubstr("IAE: mean of some runs")));
}

TEST(Verdict, GivesTheExactShareOfFailures) {
  // Steering completes 10 of 20 runs, differential 20: McNemar's p is 2/1024, and the 95 % interval
  // of 10 of 20 is [27, 73] %.
  const std::string text = verdict(twenty(0.0, 0.0, 10));
  EXPECT_THAT(text, HasSubstr("differential is best"));
  EXPECT_THAT(text, HasSubstr("steering completed 10 of 20 (95 %: 27 to 73 %)"));
}

TEST(Verdict, GivesAnIntervalOfFailuresFromTwoRunsOn) {
  Comparison c = twenty(0.0, 0.0, 1);
  const auto keep = [&](int samples) {
    Comparison kept = c;
    std::erase_if(kept.rows, [&](const ComparisonRow& row) { return row.sample > samples; });
    return verdict(kept);
  };
  EXPECT_THAT(keep(2), HasSubstr("steering completed 1 of 2 (95 %: 1 to 99 %)"));
  EXPECT_THAT(keep(1), HasSubstr("steering completed 0 of 1"));
  EXPECT_THAT(keep(1), Not(HasSubstr("95 %")));
}

TEST(Verdict, ReportsThatNoneCompleted) {
  Comparison c = twenty(3.0, 0.1);
  EXPECT_THAT(verdict(c), Not(HasSubstr("none completed")));
  for (ComparisonRow& row : c.rows) row.metrics.completed = row.sample == 1;
  EXPECT_THAT(verdict(c), Not(HasSubstr("none completed")));
  for (ComparisonRow& row : c.rows) row.metrics.completed = false;
  EXPECT_THAT(verdict(c), ::testing::StartsWith("none completed; by score "));
}

TEST(Verdict, DoesNotRankByAFailureThatMayBeChance) {
  // Steering fails one of 20 runs: McNemar's p is 1.
  EXPECT_THAT(verdict(twenty(0.0, 0.0, 1)), HasSubstr("tied"));
}

TEST(Verdict, RanksAModeThatNeverCompletesLast) {
  // Steering completes 0 of 4 runs, differential 4: McNemar's p is only 0.125. Steering is behind
  // all the same, although its settling times are shorter, because it fails every run.
  Comparison c = twenty(-3.0, 0.1, 20);
  std::erase_if(c.rows, [](const ComparisonRow& row) { return row.sample > 4; });
  const std::string text = verdict(c);
  EXPECT_THAT(text, ::testing::StartsWith("differential is best; steering is behind"));
  EXPECT_THAT(text, HasSubstr("steering completed 0 of 4"));
}

TEST(Verdict, SharesRankOneAmongEqualModes) {
  const Evaluated same = evaluate(twenty(0.0, 0.0));
  for (const RankedMode& mode : same.scenario.ranking) {
    EXPECT_EQ(mode.rank, 1);
    EXPECT_DOUBLE_EQ(mode.first_by_weights, 0.5);
    EXPECT_DOUBLE_EQ(*mode.first_by_samples, 0.5);
  }
}

TEST(Verdict, TiesModesThatAreEquivalentInEveryMetric) {
  // Ten metrics with tiny but certain differences, each a hundredth of the relevance margin.
  Comparison c = twenty(0.0, 0.0);
  for (ComparisonRow& row : c.rows) {
    row.metrics.settling_time_s = 0.01;
    row.metrics.heading_iae_degs = row.mode == YawMode::kSteering ? 0.02 : 0.0;
    row.metrics.sideslip_max_deg = row.mode == YawMode::kSteering ? 0.02 : 0.0;
  }
  EXPECT_THAT(verdict(c), HasSubstr("tied"));
  EXPECT_THAT(verdict(c), Not(HasSubstr("behind")));
}

TEST(Verdict, ReportsNoUncertaintyForASingleSample) {
  Comparison c = twenty(3.0, 0.1);
  std::erase_if(c.rows, [](const ComparisonRow& row) { return row.sample > 1; });
  EXPECT_THAT(verdict(c), HasSubstr("one sample gives no uncertainty"));
  std::erase_if(c.rows, [](const ComparisonRow& row) { return row.sample > 0; });
  EXPECT_THAT(verdict(c), HasSubstr("nominal model only, no uncertainty"));
}

TEST(Tally, CountsTheBestAndTheTied) {
  const Evaluated clear = evaluate(twenty(3.0, 0.1));
  const Evaluated alike = evaluate(twenty(0.1, 2.0));
  const auto tallies = tally({clear.scenario, alike.scenario});
  // The two metrics set above, and seven that every run has (sideslip, control variation, energy,
  // wear), all 0.
  ASSERT_EQ(tallies.size(), 9U);
  EXPECT_EQ(tallies[0].metric->name, "settling_time_s");
  EXPECT_EQ(tallies[0].scenarios, 2);
  EXPECT_THAT(tallies[0].best_or_tied, ElementsAre(2, 1));
  EXPECT_THAT(tallies[1].best_or_tied, ElementsAre(2, 2));
}

TEST(Tally, AModeWithoutTheMetricIsWorse) {
  Comparison c = twenty(-3.0, 0.1);
  for (ComparisonRow& row : c.rows) {
    if (row.mode == YawMode::kSteering) row.metrics.settling_time_s.reset();
  }
  const Evaluated one = evaluate(c);
  const auto tallies = tally({one.scenario});
  EXPECT_EQ(tallies[0].metric->name, "settling_time_s");
  EXPECT_THAT(tallies[0].best_or_tied, ElementsAre(1, 0));
  for (const MetricTally& tally : tallies) EXPECT_EQ(tally.scenarios, 1);
}

TEST(Tally, CountsScenariosWithTheSameRunsOnce) {
  const Evaluated clear = evaluate(twenty(3.0, 0.1));
  const Evaluated again = evaluate(twenty(3.0, 0.1));
  const Evaluated other = evaluate(twenty(0.1, 2.0));
  const std::vector<EvaluatedScenario> scenarios{clear.scenario, other.scenario, again.scenario};
  EXPECT_THAT(first_with_same_runs(scenarios), ElementsAre(0, 1, 0));
  for (const MetricTally& one : tally(scenarios)) EXPECT_EQ(one.scenarios, 2);
}

}  // namespace
}  // namespace awmr::testing
