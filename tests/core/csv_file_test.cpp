/// Tables read from files: their hash, pipes, long files.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <thread>

#include "awmr/core/csv.h"
#include "awmr/core/files/hash.h"
#include "awmr/core/input_file.h"
#include "core/directory_test.h"

namespace awmr::testing {
namespace {

using ::testing::EndsWith;

const std::vector<CsvColumn> kColumns = {{"t_s"}, {"z"}};

/// Rows of a log with line breaks in a quoted cell, comments and blank lines in between.
std::string rows_of(int rows) {
  std::string text = "t_s,note,z\n";
  for (int row = 0; row < rows; ++row) {
    if (row % 1000 == 500) text += "# a comment\n\n";
    text += std::to_string(row) + ".5," + (row % 1000 == 900 ? "\"a\nb\"" : "\xC3\xBC") + ",  " +
            std::to_string(row % 7) + "\n";
  }
  return text;
}

using CsvFile = DirectoryTest;

TEST_F(CsvFile, ReadsEveryRowOfALongFileWithItsPlace) {
  constexpr int kRows = 100'000;
  write_all(path("a.csv"), rows_of(kRows));
  const auto table = read_csv(path("a.csv"), kColumns).value();
  ASSERT_EQ(table.rows(), static_cast<std::size_t>(kRows));
  int line = 1;
  for (int row = 0; row < kRows; ++row) {
    const auto at = static_cast<std::size_t>(row);
    line += row % 1000 == 500 ? 3 : 1;
    ASSERT_EQ(table.column("t_s")[at], row + 0.5);
    ASSERT_EQ(table.column("z")[at], row % 7);
    ASSERT_EQ(table.line(at), line);
    if (row % 1000 == 900) ++line;
  }
  EXPECT_THAT(table.place(0, "z"), EndsWith("a.csv:2:9"));
  EXPECT_THAT(table.place(900, "z"), EndsWith("a.csv:904:6"));
  EXPECT_THAT(table.place(901, "z"), EndsWith("a.csv:906:11"));
}

TEST_F(CsvFile, RecordsTheHashOfTheBytes) {
  const std::string text = rows_of(2000);
  write_all(path("a.csv"), text);
  ASSERT_TRUE(read_csv(path("a.csv"), kColumns).has_value());
  EXPECT_EQ(input_file(path("a.csv")).value().sha256, sha256_hex(text));
}

TEST_F(CsvFile, ReadsAPipe) {
  const std::string text = rows_of(100'000);
  ASSERT_EQ(::mkfifo(path("a.csv").c_str(), 0600), 0);
  std::thread writer([&] { write_all(path("a.csv"), text); });
  const auto table = read_csv(path("a.csv"), kColumns);
  writer.join();
  ASSERT_TRUE(table.has_value()) << to_text(table.error());
  EXPECT_EQ(table->rows(), 100'000U);
  EXPECT_EQ(input_file(path("a.csv")).value().sha256, sha256_hex(text));
}

}  // namespace
}  // namespace awmr::testing
