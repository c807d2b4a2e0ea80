/// Ranges of numbers: ends, NaN, infinity and their texts.
#include "awmr/core/number_rule.h"

#include <gtest/gtest.h>

#include <limits>

namespace awmr::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(NumberRule, ExcludesItsEndsWhereItSaysSo) {
  const NumberRule open{.min = 0.0, .max = 1.0, .min_excluded = true, .max_excluded = true};
  const NumberRule closed{.min = 0.0, .max = 1.0};
  for (const double end : {0.0, 1.0}) {
    EXPECT_FALSE(allows(open, end));
    EXPECT_TRUE(allows(closed, end));
  }
  EXPECT_TRUE(allows(open, 0.5));
  EXPECT_FALSE(allows(closed, 1.5));
}

TEST(NumberRule, AllowsNoNanAndNoInfinity) {
  for (const NumberRule& rule : {kAnyNumber, kPositive, kNonNegative}) {
    EXPECT_FALSE(allows(rule, kNan));
    EXPECT_FALSE(allows(rule, kInfinite));
    EXPECT_FALSE(allows(rule, Interval{1.0, kInfinite}));
    EXPECT_FALSE(allows(rule, Interval{kNan, 1.0}));
  }
  EXPECT_TRUE(allows(kAnyNumber, -1e300));
}

TEST(NumberRule, AllowsAnIntervalWhoseEndsAreInOrderAndInRange) {
  EXPECT_TRUE(allows(kPositive, Interval{1.0, 1.0}));
  EXPECT_FALSE(allows(kPositive, Interval{2.0, 1.0}));
  EXPECT_FALSE(allows(kPositive, Interval{0.0, 1.0}));
}

TEST(NumberRule, IsDescribedByItsEnds) {
  EXPECT_EQ(describe(kAnyNumber), "a number");
  EXPECT_EQ(describe(kPositive), "a number above 0");
  EXPECT_EQ(describe(NumberRule{.max = 2.0}), "a number at most 2");
  EXPECT_EQ(describe(NumberRule{.min = 0.0, .max = 1.0, .max_excluded = true}),
            "a number at least 0 and below 1");
}

}  // namespace
}  // namespace awmr::testing
