#include "awmr/core/statistics/binomial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "awmr/compare/statistics.h"

namespace awmr::testing {
namespace {

TEST(ClopperPearson, IsExactAtTheEnds) {
  // For 0 of n the upper end solves (1 - p)^n = 0.025; for n of n the lower end follows by
  // symmetry.
  EXPECT_EQ(clopper_pearson(0, 20).lo, 0.0);
  EXPECT_NEAR(clopper_pearson(0, 20).hi, 1.0 - std::pow(0.025, 1.0 / 20.0), 1e-12);
  EXPECT_NEAR(clopper_pearson(20, 20).lo, std::pow(0.025, 1.0 / 20.0), 1e-12);
  EXPECT_EQ(clopper_pearson(20, 20).hi, 1.0);
}

TEST(ClopperPearson, LeavesATailOfTwoAndAHalfPercentOnEachSide) {
  const Interval share = clopper_pearson(7, 30);
  const auto tail = [](double p, int from, int to) {
    double sum = 0.0;
    for (int k = from; k <= to; ++k) {
      sum += std::exp(std::lgamma(31.0) - std::lgamma(k + 1.0) - std::lgamma(31.0 - k) +
                      k * std::log(p) + (30 - k) * std::log1p(-p));
    }
    return sum;
  };
  EXPECT_NEAR(tail(share.lo, 7, 30), 0.025, 1e-9);
  EXPECT_NEAR(tail(share.hi, 0, 7), 0.025, 1e-9);
}

TEST(McNemar, IsTheSignTestOfTheDiscordantPairs) {
  EXPECT_EQ(mcnemar_p(0, 0), 1.0);
  EXPECT_NEAR(mcnemar_p(0, 6), 2.0 / 64.0, 1e-12);
  EXPECT_NEAR(mcnemar_p(1, 5), 2.0 * 7.0 / 64.0, 1e-12);
  EXPECT_EQ(mcnemar_p(3, 3), 1.0);
}

TEST(PairedT, HasTheTablesQuantiles) {
  // The 97.5 % quantile of t with 9 degrees of freedom is 2.262157. A mean of 2.262157 standard
  // errors therefore has p = 5 %.
  EXPECT_NEAR(paired_t_p(2.262157, std::sqrt(10.0), 10), 0.05, 1e-6);
  EXPECT_EQ(paired_t_p(0.0, 0.0, 5), 1.0);
  EXPECT_EQ(paired_t_p(1.0, 0.0, 5), 0.0);
}

TEST(Equivalence, IsTheOneSidedTestAgainstTheMargin) {
  // The mean is one standard error inside the margin, then one outside. With 2 degrees of freedom,
  // p = 1/2 -+ 1/(2 sqrt 3).
  EXPECT_NEAR(equivalence_p(-0.5, 0.5 * std::sqrt(3.0), 3, 1.0), 0.5 - 0.5 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(equivalence_p(1.5, 0.5 * std::sqrt(3.0), 3, 1.0), 0.5 + 0.5 / std::sqrt(3.0), 1e-12);
  EXPECT_EQ(equivalence_p(1.0, 0.0, 3, 1.0), 0.0);
  EXPECT_EQ(equivalence_p(1.1, 0.0, 3, 1.0), 1.0);
}

TEST(Holm, StepsDownAndKeepsTheOrder) {
  // Sorted by increasing p, the corrected values are 4 * 0.01, 3 * 0.02, 2 * 0.03 and 1 * 0.2. Each
  // is raised to the previous one if it is smaller.
  const std::vector<double> p = {0.03, 0.01, 0.2, 0.02};
  const std::vector<double> corrected = holm(p);
  EXPECT_NEAR(corrected[1], 0.04, 1e-15);
  EXPECT_NEAR(corrected[3], 0.06, 1e-15);
  EXPECT_NEAR(corrected[0], 0.06, 1e-15);
  EXPECT_NEAR(corrected[2], 0.2, 1e-15);
}

}  // namespace
}  // namespace awmr::testing
