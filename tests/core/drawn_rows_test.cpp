/// Thinning of a curve's rows for drawing keeps the visible features: peaks, corners, both ends.
#include "awmr/core/statistics/drawn_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace awmr::testing {
namespace {

using Signal = std::vector<double>;

Signal times(std::size_t rows) {
  Signal t(rows);
  for (std::size_t i = 0; i < rows; ++i) t[i] = 0.01 * static_cast<double>(i);
  return t;
}

/// Largest distance of the signal `y` from straight lines between the selected rows, relative to
/// its range.
double worst_distance(const Signal& t, const Signal& y, const std::vector<std::size_t>& rows) {
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  double worst = 0.0;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    for (std::size_t i = rows[k]; i <= rows[k + 1]; ++i) {
      const double share = (t[i] - t[rows[k]]) / (t[rows[k + 1]] - t[rows[k]]);
      const double line = y[rows[k]] + share * (y[rows[k + 1]] - y[rows[k]]);
      worst = std::max(worst, std::abs(y[i] - line) / (*high - *low));
    }
  }
  return worst;
}

TEST(DrawnRows, APeakOfOneRowStays) {
  const Signal t = times(5000);
  Signal y(t.size(), 1.0);
  y[1234] = 7.0;
  const std::vector<Signal> signals{y, Signal(t.size(), 0.0)};
  EXPECT_THAT(drawn_rows(t, signals, 0.001, 100),
              ::testing::ElementsAre(0, 1233, 1234, 1235, 4999));
}

TEST(DrawnRows, EverySignalIsWithinTheToleranceAndTheRowsAreFew) {
  const Signal t = times(4000);
  std::vector<Signal> signals(2, Signal(t.size()));
  for (std::size_t i = 0; i < t.size(); ++i) {
    signals[0][i] = 3.0 * std::sin(t[i]);
    signals[1][i] = 1e-6 * std::abs(std::fmod(t[i], 4.0) - 2.0);
  }
  const std::vector<std::size_t> rows = drawn_rows(t, signals, 0.002, 4000);
  EXPECT_LT(rows.size(), 300u);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  EXPECT_EQ(rows.front(), 0u);
  EXPECT_EQ(rows.back(), t.size() - 1);
  for (const Signal& y : signals) EXPECT_LE(worst_distance(t, y, rows), 0.002 * (1 + 1e-12));
}

TEST(DrawnRows, NoiseIsHeldToTheMostWithItsLargestPeak) {
  const Signal t = times(3000);
  Signal y(t.size());
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = static_cast<double>(i * 7919 % 1000) / 1000.0;
  y[777] = 5.0;
  const std::vector<std::size_t> rows = drawn_rows(t, std::vector<Signal>{y}, 0.001, 200);
  EXPECT_LE(rows.size(), 200u);
  EXPECT_THAT(rows, ::testing::Contains(777u));
}

TEST(DrawnRows, ReturnsNoRowsForAnEmptySignal) {
  EXPECT_TRUE(drawn_rows(Signal{}, {}, 0.01, 10).empty());
  EXPECT_THAT(drawn_rows(Signal{0.0}, std::vector<Signal>{{4.0}}, 0.01, 10),
              ::testing::ElementsAre(0));
}

}  // namespace
}  // namespace awmr::testing
