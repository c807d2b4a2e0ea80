#include "awmr/compare/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "awmr/compare/ranking.h"
#include "awmr/core/random.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ComparisonRow row(YawMode mode, int sample, double iae_degs, bool completed = true) {
  ComparisonRow r{.scenario = "s", .mode = mode, .sample = sample, .metrics = {}};
  r.metrics.completed = completed;
  r.metrics.heading_iae_degs = iae_degs;
  return r;
}

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  const std::vector<double> values = {1.0, 2.0, 4.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.5), 2.0);
  EXPECT_EQ(quantile(values, 0.75), 3.0);
  EXPECT_EQ(quantile(values, 1.0), 4.0);
  EXPECT_EQ(quantile(std::vector<double>{7.0}, 0.3), 7.0);
}

TEST(Summary, LeavesTheNominalRunOutOfTheSamples) {
  Comparison c;
  for (int i = 0; i <= 4; ++i) {
    c.rows.push_back(row(YawMode::kSteering, i, i == 0 ? 100.0 : i));
  }
  const auto groups = group(c);
  const Summary s = summarise(groups[0].modes[0], column_of(MetricId::kHeadingIae));
  EXPECT_EQ(s.nominal, 100.0);
  EXPECT_EQ(s.count, 4U);
  EXPECT_EQ(s.mean, 2.5);
  EXPECT_EQ(s.q50, 2.5);
  EXPECT_FALSE(summarise(groups[0].modes[0], column_of(MetricId::kClearance)).mean);
}

TEST(Summary, WithoutSamplesHasTheNominalMeanAndNoQuantiles) {
  Comparison c;
  c.rows.push_back(row(YawMode::kSteering, 0, 3.0));
  const auto groups = group(c);
  const Summary s = summarise(groups[0].modes[0], column_of(MetricId::kHeadingIae));
  EXPECT_EQ(s.mean, 3.0);
  EXPECT_FALSE(s.q05 || s.q50 || s.q95);
}

/// Steering is 1 worse than differential in every sample, up to noise that both share.
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
  for (const PairedDifference& d : paired_differences(group(c)[0], seed, 0)) {
    if (d.metric == MetricId::kHeadingIae) return d;
  }
  return {};
}

TEST(PairedDifferences, CancelWhatTheModesShare) {
  const PairedDifference d = iae_difference(paired(100, 0.0), 1);
  EXPECT_EQ(d.first.mode, YawMode::kDifferential);
  EXPECT_EQ(d.second.mode, YawMode::kSteering);
  EXPECT_EQ(d.count, 100U);
  // Differences of numbers near 50: a few units of 50 * 2^-53.
  EXPECT_NEAR(*d.mean, -1.0, 1e-13);
  ASSERT_TRUE(d.ci95);
  EXPECT_NEAR(d.ci95->lo, -1.0, 1e-13);
  EXPECT_NEAR(d.ci95->hi, -1.0, 1e-13);
}

TEST(PairedDifferences, HaveTheWidthOfTheMeansStandardError) {
  const PairedDifference d = iae_difference(paired(400, 0.5), 1);
  ASSERT_TRUE(d.ci95);
  EXPECT_TRUE(d.ci95->contains(*d.mean));
  // 2 * 1.96 * 0.5/sqrt(400) = 0.098; the sample's own deviation is known to 1/sqrt(800) = 3.5 %
  // and the ends of 1000 resamples to 4 % each: 20 % is more than three of all together.
  EXPECT_NEAR(d.ci95->hi - d.ci95->lo, 0.098, 0.2 * 0.098);
}

TEST(PairedDifferences, HaveNoIntervalBelowTwoSamples) {
  EXPECT_FALSE(iae_difference(paired(0, 0.5), 1).ci95);
  EXPECT_FALSE(iae_difference(paired(1, 0.5), 1).ci95);
  EXPECT_TRUE(iae_difference(paired(2, 0.5), 1).ci95);
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

std::vector<int> ranks(const std::vector<RankedMode>& ranking) {
  std::vector<int> all;
  for (const RankedMode& mode : ranking) all.push_back(mode.rank);
  return all;
}

TEST(Ranking, PutsTheLowestScoreFirstAndNamesTies) {
  Comparison c;
  c.rows = {row(YawMode::kDifferential, 0, 20.0), row(YawMode::kSteering, 0, 40.0),
            row(YawMode::kCombined, 0, 20.0)};
  const auto ranking = rank(group(c)[0]);
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
  const auto ranking = rank(group(c)[0]);
  EXPECT_EQ(ranking[0].contender.mode, YawMode::kCombined);
  EXPECT_EQ(ranking[2].contender.mode, YawMode::kDifferential);
  EXPECT_EQ(ranking[2].rank, 3);
}

TEST(Ranking, IgnoresDifferencesBelowTheFloor) {
  Comparison c;
  c.rows = {row(YawMode::kDifferential, 0, 20.0), row(YawMode::kSteering, 0, 20.0),
            row(YawMode::kCombined, 0, 20.0)};
  // 0.001 and 0.004 deg: against the floor of 0.5 deg, over four ranked metrics, below 0.01.
  c.rows[0].metrics.overshoot_deg = 0.001;
  c.rows[1].metrics.overshoot_deg = 0.004;
  c.rows[2].metrics.overshoot_deg = 0.0;
  EXPECT_THAT(ranks(rank(group(c)[0])), ElementsAre(1, 1, 1));
}

TEST(Ranking, IsEmptyWhereThereIsNothingToFollow) {
  Comparison c;
  ComparisonRow open{.scenario = "s", .mode = YawMode::kSteering, .sample = 0, .metrics = {}};
  c.rows = {open};
  EXPECT_THAT(rank(group(c)[0]), IsEmpty());
}

}  // namespace
}  // namespace awmr::testing
