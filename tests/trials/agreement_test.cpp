#include "awmr/trials/checks/agreement.h"

#include <gtest/gtest.h>

#include "support/scratch_file.h"

namespace awmr::testing::agreement_test {
namespace {

double last_place_of(const std::string& cells, std::span<const ColumnMapping> mappings = {}) {
  const ScratchFile file("a.csv", "v\n" + cells);
  const CsvColumn columns[] = {{mappings.empty() ? "v" : mappings[0].name, true}};
  const auto table = read_csv(file.path(), columns, mappings);
  if (!table) {
    ADD_FAILURE() << to_text(table.error());
    return -1.0;
  }
  return last_place(*table, columns[0].name, mappings);
}

TEST(Agreement, TakesTheFinestPlaceOfAColumn) {
  EXPECT_DOUBLE_EQ(last_place_of("79.16\n35.3\n18\n"), 0.01);
  EXPECT_DOUBLE_EQ(last_place_of("5\n10\n"), 1.0);
  EXPECT_DOUBLE_EQ(last_place_of("0\n"), 1.0);
  EXPECT_DOUBLE_EQ(last_place_of("1200\n"), 1.0);
  EXPECT_DOUBLE_EQ(last_place_of("0.265\n0.15\n"), 0.001);
  EXPECT_DOUBLE_EQ(last_place_of("-0.038\n"), 0.001);
  EXPECT_DOUBLE_EQ(last_place_of("1e-5\n"), 1e-5);
  EXPECT_DOUBLE_EQ(last_place_of("1.25e2\n"), 1.0);
}

TEST(Agreement, UsesTheFilesDigitsThroughAMapping) {
  const ColumnMapping kmh[] = {{"speed_mps", "v", 1.0 / 3.6, 0.0}};
  EXPECT_DOUBLE_EQ(last_place_of("3.7\n4.1\n", kmh), 0.1 / 3.6);
  const ColumnMapping shifted[] = {{"speed_mps", "v", 0.01, 0.3}};
  EXPECT_DOUBLE_EQ(last_place_of("12\n17\n", shifted), 0.01);
}

TEST(Agreement, RoundsByHalfAPlaceButNeverByMoreThanFivePercent) {
  EXPECT_DOUBLE_EQ(rounding_error(1.03, 0.01), 0.005);
  EXPECT_DOUBLE_EQ(rounding_error(-1.0, 1.0), 0.05);
  EXPECT_DOUBLE_EQ(rounding_error(0.0, 0.01), 0.0);
}

TEST(Agreement, TimesByHandOrToTheUnitOfAnAutomaticClock) {
  // By stop watch: 2 (0.2/8 + 0.005) = 0.06. Timed to the millisecond: 2 (0.001/8 + 0.005) =
  // 0.01025.
  EXPECT_DOUBLE_EQ(timing_error(2.0, 8.0, 0.01), 0.06);
  EXPECT_DOUBLE_EQ(timing_error(2.0, 8.0, 0.001), 0.01025);
}

}  // namespace
}  // namespace awmr::testing::agreement_test
