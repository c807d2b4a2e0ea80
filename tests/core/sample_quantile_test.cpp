/// Quantiles and medians of samples, compared with their definitions.
#include "awmr/core/statistics/sample_quantile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace awmr::testing {
namespace {

TEST(SampleQuantile, IsLinearBetweenOrderStatistics) {
  const std::vector<double> values = {1.0, 2.0, 4.0};
  EXPECT_EQ(quantile_of_sorted(values, 0.0), 1.0);
  EXPECT_EQ(quantile_of_sorted(values, 0.5), 2.0);
  EXPECT_EQ(quantile_of_sorted(values, 0.75), 3.0);
  EXPECT_EQ(quantile_of_sorted(values, 1.0), 4.0);
  EXPECT_EQ(quantile_of_sorted(std::vector<double>{7.0}, 0.3), 7.0);
}

TEST(SampleQuantile, OfValuesInAnyOrderIsThatOfTheSortedValues) {
  std::mt19937 random(1);
  for (std::size_t count : {1, 2, 3, 10, 101}) {
    std::vector<double> values(count);
    for (double& value : values) value = static_cast<double>(random() % 50);
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const double p : {0.0, 0.02, 0.25, 0.5, 0.9, 0.95, 1.0}) {
      EXPECT_EQ(quantile(values, p), quantile_of_sorted(sorted, p)) << count << " values, " << p;
    }
  }
}

TEST(SampleQuantile, OfAnInfiniteValueIsNotNan) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(quantile({1.0, infinity}, 0.0), 1.0);
  EXPECT_EQ(quantile({1.0, infinity}, 1.0), infinity);
}

TEST(RankQuantile, IsNotExceededByTheShareOfTheValues) {
  std::vector<double> values;
  for (int i = 1; i <= 20; ++i) values.push_back(i);
  EXPECT_EQ(rank_quantile(values, 0.95), 19.0);
  EXPECT_EQ(rank_quantile(values, 0.951), 20.0);
  EXPECT_EQ(rank_quantile(values, 0.05), 1.0);
  EXPECT_EQ(rank_quantile(values, 0.0), 1.0);
  EXPECT_EQ(rank_quantile(values, 1.0), 20.0);
  // In double, 0.07 * 100 is 7.000000000000001, which must not count as rank 8.
  std::vector<double> hundred;
  for (int i = 1; i <= 100; ++i) hundred.push_back(i);
  EXPECT_EQ(rank_quantile(hundred, 0.07), 7.0);
}

TEST(Median, IsTheUpperMiddleValue) {
  EXPECT_EQ(median({3.0}), 3.0);
  EXPECT_EQ(median({4.0, 1.0}), 4.0);
  EXPECT_EQ(median({9.0, 1.0, 5.0}), 5.0);
  EXPECT_EQ(median_absolute_deviation(std::vector<double>{1.0, 5.0, 7.0}, 5.0), 2.0);
}

}  // namespace
}  // namespace awmr::testing
