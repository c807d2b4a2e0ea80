/// Resistance table of the chip, by hand: cell ends, interpolation between them, extrapolation.
#include "awmr/control/resistance_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "awmr/control/feed_forward.h"

namespace awmr::testing {
namespace {

/// Table with two cells per octave, which begins at 1. Its values are 10 at 1, 11 at 1.5, 13 at 2,
/// 17 at 3 and 25 at 4.
constexpr ResistanceLine kLines[] = {
    {10.0F, 0.0F}, {2.0F, 8.0F}, {4.0F, 5.0F}, {4.0F, 5.0F}, {8.0F, -7.0F}};
const ResistanceTable kTable{
    .lines = kLines, .count = 5, .first = ResistanceTable::cell_of(1.0F, 1), .mantissa_bits = 1};

TEST(ResistanceTable, HoldsTheEndsOfItsCells) {
  EXPECT_EQ(kTable(1.0F), 10.0F);
  EXPECT_EQ(kTable(1.5F), 11.0F);
  EXPECT_EQ(kTable(2.0F), 13.0F);
  EXPECT_EQ(kTable(3.0F), 17.0F);
}

TEST(ResistanceTable, IsTheChordBetweenThem) {
  EXPECT_EQ(kTable(1.25F), 10.5F);
  EXPECT_EQ(kTable(1.75F), 12.0F);
  EXPECT_EQ(kTable(2.25F), 14.0F);
  EXPECT_EQ(kTable(3.5F), 21.0F);
}

TEST(ResistanceTable, IsTheChordToTheOriginBelowTheFirst) {
  EXPECT_EQ(kTable(0.5F), 5.0F);
  EXPECT_EQ(kTable(std::nextafterf(1.0F, 0.0F)), 10.0F * std::nextafterf(1.0F, 0.0F));
  EXPECT_EQ(kTable(0.0F), 0.0F);
}

TEST(ResistanceTable, IsOdd) {
  for (const float speed : {0.25F, 1.0F, 1.25F, 3.5F}) EXPECT_EQ(kTable(-speed), -kTable(speed));
}

TEST(RestingTable, IsFedForwardBySpeedAndIntent) {
  const RestingTable table{kTable, 0.5F, 5.0F};
  EXPECT_EQ(table(0.25F), 2.5F);
  EXPECT_EQ(table(1.25F), kTable(1.25F));
  EXPECT_EQ(fed_forward(table, 0.1F, 0.1F), 2.0F);  // 5 (0.1 + 0.1)/0.5
  EXPECT_FLOAT_EQ(fed_forward(table, -0.1F, 0.3F), 2.0F);
  EXPECT_EQ(fed_forward(table, 0.1F, 9.0F), 5.0F);
  EXPECT_EQ(fed_forward(table, -0.1F, -9.0F), -5.0F);
  EXPECT_EQ(fed_forward(table, 1.25F, -9.0F), kTable(1.25F));
}

TEST(ResistanceTable, IsNaNFromTheLastCellOn) {
  EXPECT_FALSE(std::isnan(kTable(std::nextafterf(4.0F, 0.0F))));
  for (const float speed : {4.0F, 5.0F, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    EXPECT_TRUE(std::isnan(kTable(speed))) << speed;
    EXPECT_TRUE(std::isnan(kTable(-speed))) << speed;
  }
}

}  // namespace
}  // namespace awmr::testing
