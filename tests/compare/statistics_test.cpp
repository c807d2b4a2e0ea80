#include "awmr/compare/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "awmr/compare/ranking.h"
#include "awmr/core/random.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const MetricColumn& metric_named(std::string_view name) {
  return *std::ranges::find(kMetricColumns, name, &MetricColumn::name);
}

ComparisonRow row(YawMode mode, int sample, double iae_degs, bool completed = true) {
  ComparisonRow r{.scenario = "s", .mode = mode, .sample = sample, .metrics = {}};
  r.metrics.completed = completed;
  r.metrics.heading_iae_degs = iae_degs;
  return r;
}

TEST(Summary, LeavesTheNominalRunOutOfTheSamples) {
  Comparison c;
  for (int i = 0; i <= 4; ++i) {
    c.rows.push_back(row(YawMode::kSteering, i, i == 0 ? 100.0 : i));
  }
  const auto groups = group(c);
  const Summary s = summarise(groups[0].modes[0], metric_named("heading_iae_degs"));
  EXPECT_EQ(s.nominal, 100.0);
  EXPECT_EQ(s.count, 4U);
  EXPECT_EQ(s.mean, 2.5);
  EXPECT_NEAR(*s.q05, 1.15, 1e-15);
  EXPECT_EQ(s.q50, 2.5);
  EXPECT_NEAR(*s.q95, 3.85, 1e-15);
  EXPECT_FALSE(summarise(groups[0].modes[0], metric_named("clearance_min_m")).mean);
}

TEST(Summary, CountsTheSamplesThatWereCompleted) {
  Comparison c;
  for (int i = 0; i <= 4; ++i) c.rows.push_back(row(YawMode::kSteering, i, 3.0, i == 2));
  EXPECT_EQ(group(c)[0].modes[0].completed_share(), 0.25);
}

TEST(Summary, WithoutSamplesHasTheNominalMeanAndNoQuantiles) {
  Comparison c;
  c.rows.push_back(row(YawMode::kSteering, 0, 3.0));
  const auto groups = group(c);
  const Summary s = summarise(groups[0].modes[0], metric_named("heading_iae_degs"));
  EXPECT_EQ(s.mean, 3.0);
  EXPECT_FALSE(s.q05 || s.q50 || s.q95);
}

/// Comparison in whose samples the metric of steering exceeds that of differential by 1 on average.
/// Both metrics contain the same noise.
Comparison paired(int samples, double difference_spread) {
  Comparison c;
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering}) {
    for (int i = 0; i <= samples; ++i) {
      Random shared(3, static_cast<std::uint64_t>(i));
      const double common = 50.0 + 10.0 * shared.normal();
      const double extra =
          mode == YawMode::kSteering ? 1.0 + difference_spread * shared.normal() : 0.0;
      c.rows.push_back(row(mode, i, common + extra));
    }
  }
  return c;
}

PairedDifference iae_difference(const Comparison& c, std::uint64_t seed) {
  for (const PairedDifference& d : statistics_of(group(c)[0], {}, seed).differences) {
    if (d.metric->name == "heading_iae_degs") return d;
  }
  return {};
}

TEST(PairedDifferences, CancelCommonVariation) {
  const PairedDifference d = iae_difference(paired(100, 0.0), 1);
  EXPECT_EQ(d.first.mode, YawMode::kDifferential);
  EXPECT_EQ(d.second.mode, YawMode::kSteering);
  EXPECT_EQ(d.count, 100U);
  // Tolerance: rounding of differences of numbers near 50, a few times 50 * 2^-53.
  EXPECT_NEAR(*d.mean, -1.0, 1e-13);
  ASSERT_TRUE(d.ci95);
  EXPECT_NEAR(d.ci95->lo, -1.0, 1e-13);
  EXPECT_NEAR(d.ci95->hi, -1.0, 1e-13);
}

TEST(PairedDifferences, HaveTheWidthOfTheMeansStandardError) {
  const PairedDifference d = iae_difference(paired(400, 0.5), 1);
  ASSERT_TRUE(d.ci95);
  EXPECT_TRUE(d.ci95->contains(*d.mean));
  // The width is 2 * 1.96 * 0.5/sqrt(400) = 0.098. The standard deviation of the sample has an
  // error of 1/sqrt(800) = 3.5 %, each end from 1000 resamples one of 4 %. The tolerance of 20 % is
  // more than three times the combined error.
  EXPECT_NEAR(d.ci95->hi - d.ci95->lo, 0.098, 0.2 * 0.098);
}

TEST(Bootstrap, LeavesOutLessForFewValues) {
  // The tail is Phi(-t sqrt(n/(n - 1))). For n = 10, t with 9 degrees of freedom is 2.2622, the
  // root is 1.0541, and Phi(-2.3846) = 0.00855.
  EXPECT_NEAR(bootstrap_tail(10, 0.025), 0.00855, 2e-5);
  EXPECT_NEAR(bootstrap_tail(100000, 0.025), 0.025, 1e-5);
  EXPECT_LT(bootstrap_tail(2, 0.025), 1e-12);
  EXPECT_EQ(bootstrap_tail(1, 0.025), 0.025);
}

TEST(Bootstrap, CoversAMeanOfTenAtItsRate) {
  int held = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    Random random(17, static_cast<std::uint64_t>(trial));
    Comparison c;
    for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering}) {
      for (int i = 0; i <= 10; ++i) {
        ComparisonRow row{.scenario = "s", .mode = mode, .sample = i, .metrics = {}};
        row.metrics.settling_time_s = 5.0 + (mode == YawMode::kSteering ? 0.0 : random.normal());
        row.metrics.heading_iae_degs = 1.0;
        c.rows.push_back(row);
      }
    }
    const std::vector<ScenarioRows> scenarios = group(c);
    for (const PairedDifference& d :
         statistics_of(scenarios.front(), {}, static_cast<std::uint64_t>(trial)).differences) {
      if (d.metric->name == "settling_time_s") held += d.ci95->contains(0.0) ? 1 : 0;
    }
  }
  // About 95 % of 400 intervals must contain the true mean; the bounds are three standard
  // deviations of this count. With plain bootstrap percentiles, only 90 % would contain it.
  EXPECT_GT(held, 367);
  EXPECT_LT(held, 393);
}

TEST(PairedDifferences, HaveStudentsP) {
  Comparison c;
  const double extra[] = {9.0, 1.0, 2.0, 4.0};
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering}) {
    for (int i = 0; i <= 3; ++i) {
      c.rows.push_back(row(mode, i, mode == YawMode::kSteering ? 50.0 : 50.0 + extra[i]));
    }
  }
  const PairedDifference d = iae_difference(c, 1);
  EXPECT_EQ(*d.nominal, 9.0);
  EXPECT_NEAR(*d.mean, 7.0 / 3.0, 1e-14);
  // s^2 = 7/3, so t = (7/3)/sqrt(7/9) = sqrt 7; with 2 degrees of freedom p = 1 - t/sqrt(2 + t^2).
  EXPECT_NEAR(*d.p, 1.0 - std::sqrt(7.0) / 3.0, 1e-12);
  // The margin is 5 % of 50: t = (2.5 - 7/3)/sqrt(7/9), one-sided.
  const double t = (2.5 - 7.0 / 3.0) / std::sqrt(7.0 / 9.0);
  EXPECT_EQ(d.margin, 2.5);
  EXPECT_NEAR(*d.p_equivalent, 0.5 * (1.0 - t / std::sqrt(2.0 + t * t)), 1e-12);
}

TEST(PairedDifferences, HaveNoIntervalBelowTwoSamples) {
  EXPECT_FALSE(iae_difference(paired(0, 0.5), 1).ci95);
  EXPECT_FALSE(iae_difference(paired(1, 0.5), 1).ci95);
  EXPECT_FALSE(iae_difference(paired(1, 0.5), 1).p);
  EXPECT_TRUE(iae_difference(paired(2, 0.5), 1).ci95);
  EXPECT_TRUE(iae_difference(paired(2, 0.5), 1).p);
}

TEST(PairedDifferences, DependOnTheSeedAlone) {
  const Comparison c = paired(20, 0.5);
  EXPECT_EQ(iae_difference(c, 1).ci95->lo, iae_difference(c, 1).ci95->lo);
  EXPECT_NE(iae_difference(c, 1).ci95->lo, iae_difference(c, 2).ci95->lo);
}

TEST(PairedDifferences, PairOnlySamplesThatBothModesHave) {
  Comparison c = paired(3, 0.0);
  c.rows[1].metrics.heading_iae_degs.reset();  // differential, sample 1
  const PairedDifference d = iae_difference(c, 1);
  EXPECT_EQ(d.count, 2U);
  EXPECT_NEAR(*d.mean, -1.0, 1e-13);
}

std::vector<RankedMode> ranking_of(const Comparison& c, const Preferences& preferences = {}) {
  const ScenarioRows scenario = group(c)[0];
  return rank(scenario, statistics_of(scenario, preferences, 1), preferences);
}

std::vector<int> ranks(const std::vector<RankedMode>& ranking) {
  std::vector<int> all;
  for (const RankedMode& mode : ranking) all.push_back(mode.rank);
  return all;
}

TEST(Ranking, PutsTheLowestScoreFirstAndNamesTies) {
  Comparison c;
  c.rows = {row(YawMode::kDifferential, 0, 20.0), row(YawMode::kSteering, 0, 40.0),
            row(YawMode::kCombined, 0, 20.0)};
  const auto ranking = ranking_of(c);
  EXPECT_THAT(ranks(ranking), ElementsAre(1, 1, 3));
  EXPECT_THAT(ranking[0].tied_with, ElementsAre("combined"));
  EXPECT_THAT(ranking[1].tied_with, ElementsAre("differential"));
  EXPECT_EQ(ranking[2].contender.mode, YawMode::kSteering);
  EXPECT_THAT(ranking[2].tied_with, IsEmpty());
  EXPECT_GT(ranking[2].score, ranking[0].score);
}

TEST(Ranking, NeverLetsAFailureBeatASuccess) {
  Comparison c;
  c.rows = {row(YawMode::kDifferential, 0, 1.0, false), row(YawMode::kSteering, 0, 40.0),
            row(YawMode::kCombined, 0, 20.0)};
  const auto ranking = ranking_of(c);
  EXPECT_EQ(ranking[0].contender.mode, YawMode::kCombined);
  EXPECT_EQ(ranking[2].contender.mode, YawMode::kDifferential);
  EXPECT_EQ(ranking[2].rank, 3);
}

TEST(Ranking, IgnoresDifferencesBelowTheFloor) {
  Comparison c;
  c.rows = {row(YawMode::kDifferential, 0, 20.0), row(YawMode::kSteering, 0, 20.0),
            row(YawMode::kCombined, 0, 20.0)};
  // Overshoots of up to 0.004 deg change the logarithm of the score, over four ranked metrics, by
  // ln((0.004 + 0.5)/0.5)/4 = 0.002. This is below the relevance margin ln 1.05.
  c.rows[0].metrics.overshoot_deg = 0.001;
  c.rows[1].metrics.overshoot_deg = 0.004;
  c.rows[2].metrics.overshoot_deg = 0.0;
  EXPECT_THAT(ranks(ranking_of(c)), ElementsAre(1, 1, 1));
}

/// Comparison of 40 samples with these mean settling times of the modes differential, steering and
/// combined, and a spread of 0.1 s. `failures`: number of runs that each mode fails.
Comparison settling(std::array<double, 3> seconds, std::array<int, 3> failures = {0, 0, 0}) {
  constexpr YawMode kModes[] = {YawMode::kDifferential, YawMode::kSteering, YawMode::kCombined};
  Comparison c;
  for (std::size_t mode = 0; mode < 3; ++mode) {
    for (int i = 0; i <= 40; ++i) {
      Random random(7, static_cast<std::uint64_t>(i));
      ComparisonRow r = row(kModes[mode], i, 50.0, i == 0 || i > failures[mode]);
      r.metrics.settling_time_s = seconds[mode] + 0.1 * random.normal();
      c.rows.push_back(r);
    }
  }
  return c;
}

TEST(Ranking, DistinguishesEquivalentUndecidedAndBehind) {
  // One of four ranked metrics differs, so a score is (ratio)^(1/4). Both times of the ratio are
  // increased by an offset, the metric's floor divided by the relevance margin: 0.1 s/0.05 = 2 s.
  const auto ranking = ranking_of(settling({10.0, 10.5, 20.0}));
  EXPECT_THAT(ranks(ranking), ElementsAre(1, 1, 3));
  EXPECT_EQ(ranking[1].contender.mode, YawMode::kSteering);
  EXPECT_EQ(ranking[1].towards_leader, Conclusion::kEquivalent);
  EXPECT_EQ(ranking[2].towards_leader, Conclusion::kRelevant);
  EXPECT_NEAR(ranking[2].score, std::pow((20.0 + 2.0) / (10.0 + 2.0), 0.25), 2e-3);
  EXPECT_TRUE(ranking[2].behind_ci95->contains(ranking[2].score));
  EXPECT_THAT(ranking[2].dominated_by, ElementsAre("differential", "steering"));
  // The two scores are equal within the relevance margin, so each counts as first in half of the
  // samples.
  EXPECT_EQ(ranking[0].first_by_samples, 0.5);
  EXPECT_EQ(ranking[1].first_by_samples, 0.5);
  EXPECT_DOUBLE_EQ(ranking[0].first_by_weights, ranking[1].first_by_weights);
}

TEST(Ranking, OfTwoModesDoesNotDependOnAThird) {
  const double alone = ranking_of(settling({10.0, 14.0, 14.0}))[1].score;
  const double beside_a_bad_one = ranking_of(settling({10.0, 14.0, 1000.0}))[1].score;
  EXPECT_NEAR(beside_a_bad_one, alone, 1e-12);
}

TEST(Ranking, AnInsignificantFailureDoesNotPreventABestMode) {
  // One failure in 40 runs is not significant. Twelve are significant (McNemar: p = 2^-11), so the
  // mode ranks after modes with worse scores.
  EXPECT_EQ(ranking_of(settling({10.0, 30.0, 31.0}, {1, 0, 0}))[0].contender.mode,
            YawMode::kDifferential);
  const auto failing = ranking_of(settling({10.0, 30.0, 31.0}, {12, 0, 0}));
  EXPECT_EQ(failing[0].contender.mode, YawMode::kSteering);
  EXPECT_EQ(failing[2].contender.mode, YawMode::kDifferential);
  EXPECT_LT(failing[2].score, 1.0);
}

TEST(Ranking, FollowsTheUsersWeightsAndReportsItsSensitivity) {
  // Differential settles in half the time of steering with 1.75 times its motor activity. With the
  // offsets of 2 s and 1 1/s (floor divided by relevance margin) both ratios are 1.5.
  Comparison c;
  c.rows = {row(YawMode::kDifferential, 0, 50.0), row(YawMode::kSteering, 0, 50.0)};
  c.rows[0].metrics.settling_time_s = 2.0;
  c.rows[1].metrics.settling_time_s = 4.0;
  c.rows[0].metrics.control_variation = 3.5;
  c.rows[1].metrics.control_variation = 2.0;
  const auto by_time =
      ranking_of(c, *preferences_of({"settling_time_s=5", "control_variation=1"}, 0.05));
  const auto by_work = ranking_of(c, *preferences_of({"control_variation=5"}, 0.05));
  EXPECT_EQ(by_time[0].contender.mode, YawMode::kDifferential);
  EXPECT_EQ(by_work[0].contender.mode, YawMode::kSteering);
  EXPECT_THAT(by_time[0].dominated_by, IsEmpty());
  // By symmetry, each mode is first for half of all weights. With 1000 drawn weights, this fraction
  // has a standard error of 1.6 %.
  EXPECT_NEAR(by_time[0].first_by_weights, 0.5, 0.06);
  EXPECT_NEAR(by_time[0].first_by_weights + by_time[1].first_by_weights, 1.0, 1e-12);
}

TEST(Preferences, RefuseInvalidWeights) {
  for (const char* text :
       {"finish_time_s", "finish_time_s=", "finish_time_s=-1", "finish_time_s=nan",
        "finish_time_s=1001", "finish_time_s=1e400", "=1", "path_length_m=1"}) {
    EXPECT_FALSE(preferences_of({text}, 0.05)) << text;
  }
  EXPECT_FALSE(preferences_of({"tyre_work=1", "tyre_work=2"}, 0.05));
  for (const double relevance : {std::nan(""), 0.0, 0.0009, 1.1}) {
    const auto preferences = preferences_of({}, relevance);
    ASSERT_FALSE(preferences) << relevance;
    EXPECT_EQ(preferences.error().faults.front().code, ErrorCode::kOutOfRange);
  }
  for (const double relevance : {0.001, 1.0}) EXPECT_TRUE(preferences_of({}, relevance));
  for (const char* text : {"finish_time_s=0", "finish_time_s=1000"}) {
    EXPECT_TRUE(preferences_of({text}, 0.05)) << text;
  }
  const auto mistyped = preferences_of({"finish_tme_s=2"}, 0.05);
  ASSERT_FALSE(mistyped);
  EXPECT_THAT(to_text(mistyped.error()), HasSubstr("did you mean 'finish_time_s'?"));
}

TEST(PairedDifferences, AreRelevantEquivalentOrUndecided) {
  const auto conclusion = [](const Comparison& c) {
    for (const PairedDifference& d : statistics_of(group(c)[0], {}, 1).differences) {
      if (d.metric->name == "settling_time_s" && d.second.mode == YawMode::kSteering) {
        return d.conclusion;
      }
    }
    return std::optional<Conclusion>();
  };
  // The margin is 5 % of 10 s.
  EXPECT_EQ(conclusion(settling({10.0, 11.0, 10.0})), Conclusion::kRelevant);
  EXPECT_EQ(conclusion(settling({10.0, 10.4, 10.0})), Conclusion::kEquivalent);
  Comparison spread = settling({10.0, 10.4, 10.0});
  for (ComparisonRow& r : spread.rows) {
    if (r.mode != YawMode::kSteering) continue;
    *r.metrics.settling_time_s += r.sample % 2 == 0 ? 1.0 : -1.0;
  }
  EXPECT_EQ(conclusion(spread), Conclusion::kUndecided);
}

TEST(Ranking, IsEmptyInOpenLoop) {
  Comparison c;
  ComparisonRow open{.scenario = "s", .mode = YawMode::kSteering, .sample = 0, .metrics = {}};
  c.rows = {open};
  EXPECT_THAT(ranking_of(c), IsEmpty());
}

}  // namespace
}  // namespace awmr::testing
