/// The chip's table by hand: its entries, the chords between them, its two ends.
#include "awmr/control/resistance_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace awmr::testing {
namespace {

/// Two entries an octave from 1 on: at 1, 1.5, 2, 3 and 4.
constexpr float kValues[] = {10.0F, 11.0F, 13.0F, 17.0F, 25.0F};
const ResistanceTable kTable{.values = kValues,
                             .count = 5,
                             .first = ResistanceTable::cell_of(bits_of(1.0F), 1),
                             .mantissa_bits = 1,
                             .slope_at_rest = 10.0F};

TEST(ResistanceTable, HoldsItsEntries) {
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

TEST(ResistanceTable, IsNoNumberFromTheLastEntryOn) {
  EXPECT_FALSE(std::isnan(kTable(std::nextafterf(4.0F, 0.0F))));
  for (const float speed : {4.0F, 5.0F, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    EXPECT_TRUE(std::isnan(kTable(speed))) << speed;
    EXPECT_TRUE(std::isnan(kTable(-speed))) << speed;
  }
}

}  // namespace
}  // namespace awmr::testing
