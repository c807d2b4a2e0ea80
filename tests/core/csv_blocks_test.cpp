/// Reading in blocks equals reading the whole text, for any file, block size and number of threads.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "awmr/core/csv_blocks.h"
#include "awmr/core/csv_text.h"
#include "awmr/core/hash.h"
#include "awmr/core/input_file.h"
#include "core/any_finite.h"
#include "core/directory_test.h"
#include "core/faults.h"
#include "support/same_table.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<CsvColumn> kColumns = {
    {"t_s"}, {"x", false, EmptyCells::kAbsent}, {"y", false, EmptyCells::kHeld}, {"z", false}};
const std::vector<ColumnMapping> kMappings = {{"z", "raw z", 2.0, 1.0}};

Result<std::optional<CsvTable>> in_blocks(const std::string& text, const CsvBlocks& blocks,
                                          std::span<const CsvColumn> columns = kColumns) {
  return read_csv_blocks(std::make_shared<const InputBytes>("a.csv", text), columns, kMappings,
                         blocks);
}

/// Difference between the two readers; empty too if the block reader leaves the file to the other.
std::string difference_by_blocks(const std::string& text, const CsvBlocks& blocks) {
  const auto table = in_blocks(text, blocks);
  if (!table) return to_text(table.error());
  if (!*table) return {};
  const auto whole = read_csv_text(text, "a.csv", kColumns, kMappings);
  if (!whole) return to_text(whole.error());
  return difference(**table, *whole, kColumns);
}

rc::Gen<CsvBlocks> any_blocks() {
  return rc::gen::map(rc::gen::pair(rc::gen::inRange<std::size_t>(1, 100), rc::gen::inRange(1, 4)),
                      [](const std::pair<std::size_t, int>& drawn) {
                        return CsvBlocks{.bytes = drawn.first, .threads = drawn.second};
                      });
}

rc::Gen<std::string> any_of(std::vector<std::string> texts) {
  return rc::gen::elementOf(std::move(texts));
}

RC_GTEST_PROP(CsvBlocks, OfHostileBytesAreTheTableOfTheWholeText, ()) {
  const CsvBlocks blocks = *any_blocks();
  std::string text =
      *any_of({"", "t_s\n", "t_s,x\n", "t_s;x\r\n", "t_s\tx\n", "\xEF\xBB\xBFt_s,x\n", "# t_s,x\n",
               "\"t_s\",\"x\"\n", "note,t_s,y\n", "t_s,raw z\n"});
  const auto pieces = *rc::gen::container<std::vector<std::string>>(any_of({"1",
                                                                            "2.5",
                                                                            ",",
                                                                            ",",
                                                                            ";",
                                                                            "\t",
                                                                            "\n",
                                                                            "\n",
                                                                            "\r\n",
                                                                            "\r",
                                                                            "\"",
                                                                            "\"\"",
                                                                            "#",
                                                                            " ",
                                                                            "+",
                                                                            "-",
                                                                            ".",
                                                                            "e5",
                                                                            "nan",
                                                                            "1,2\n",
                                                                            "3,4\n",
                                                                            "5;6\n",
                                                                            "\"7\",8\n",
                                                                            "9,\n",
                                                                            "\n,1\n",
                                                                            "1,2\r\n",
                                                                            "# c\n",
                                                                            "0x",
                                                                            "\xC3\xBC",
                                                                            "\xFF",
                                                                            std::string(1, '\0'),
                                                                            "1.5e-3,2",
                                                                            "2026-01-31"}));
  for (const std::string& piece : pieces) text += piece;
  RC_ASSERT(difference_by_blocks(text, blocks) == "");
}

/// A file of rows as programs write them, with irregular lines in between.
RC_GTEST_PROP(CsvBlocks, OfOrdinaryFilesAreTheTableOfTheWholeText, ()) {
  const CsvBlocks blocks = *any_blocks();
  const std::string delimiter = *any_of({",", ";", "\t"});
  const std::string end = *any_of({"\n", "\r\n"});
  const bool has_dates = *rc::gen::arbitrary<bool>();
  const auto rows = *rc::gen::inRange<std::size_t>(1, 30);
  std::string text = *any_of({"", "\xEF\xBB\xBF", "# made by hand" + end, end});
  text += (has_dates ? "time" : "t_s") + delimiter + "note" + delimiter + "x" + delimiter + "y" +
          delimiter + "raw z";
  for (std::size_t row = 0; row < rows; ++row) {
    text += end + *any_of({"", "", "", "# \xC3\xBC" + end, end, "  " + end});
    text += has_dates ? "2026-01-31T12:00:" + std::to_string(10 + row) + "Z"
                      : std::to_string(row) + *any_of({"", ".5", ".25e1", " "});
    text += delimiter + *any_of({"", "text", "\xE2\x82\xAC 5", "a b", "\"q\"", "\"a\"\"b\""});
    for (int i = 0; i < 2; ++i) {
      text += delimiter + *any_of({"", "1.5", "-2", " 3.25", "+4", "\"5\"", "6e-1"});
    }
    text += delimiter + format_number(*any_finite());
  }
  text += *any_of({"", end});
  const auto whole = read_csv_text(text, "a.csv", kColumns, kMappings);
  const auto table = in_blocks(text, blocks);
  RC_ASSERT(table.has_value());
  RC_ASSERT(table->has_value() == whole.has_value());
  if (whole) RC_ASSERT(difference(**table, *whole, kColumns) == "");
}

/// Faults are reported by the reader of whole texts, with unchanged messages.
RC_GTEST_PROP(CsvBlocks, LeaveEveryFaultToTheReaderOfWholeTexts, ()) {
  const std::string bad = *any_of({"x", "", "nan", "1e999", "1,2", "\"1", "\"1\"2", "1;5", "0x5"});
  const auto at = *rc::gen::inRange(0, 20);
  std::string text = "t_s,z\n";
  for (int row = 0; row < 20; ++row) {
    text += std::to_string(row) + "," + (row == at ? bad : "1") + "\n";
  }
  const TemporaryDirectory directory;
  write_all(directory.path() / "a.csv", text);
  const auto read = read_csv(directory.path() / "a.csv", kColumns);
  const auto whole = read_csv_text(text, "a.csv", kColumns);
  RC_ASSERT(!whole.has_value());
  RC_ASSERT(faults_of(read) == faults_of(whole));
}

std::string rows_of(int first, int end, const std::string& decimals) {
  std::string text;
  for (int row = first; row < end; ++row) {
    text += std::to_string(row) + decimals + "," + std::to_string(row % 7) + "\n";
  }
  return text;
}

TEST(CsvBlocks, ThreadsAndBlocksOfALargeFileDoNotChangeIt) {
  // Rows become shorter, so there are more of them than the first block suggests.
  const std::string text = "t_s,z\n" + rows_of(0, 50'000, ".000000000000001") + "# a comment\n" +
                           rows_of(50'000, 250'000, "") + "250000,\"1\"\n\n250001,1";
  const auto whole = read_csv_text(text, "a.csv", kColumns).value();
  for (const int threads : {1, 2, 3}) {
    for (const std::size_t bytes :
         {std::size_t{1000}, std::size_t{1} << 18U, std::size_t{1} << 25U}) {
      const auto table = in_blocks(text, {.bytes = bytes, .threads = threads}).value();
      ASSERT_TRUE(table.has_value());
      EXPECT_EQ(difference(*table, whole, kColumns, 50'000), "") << threads << " " << bytes;
    }
  }
}

TEST(CsvBlocks, AreNotForQuotesOverLinesNorOldMacLineEndsNorDecimalCommas) {
  for (const std::string text : {"t_s,note\n1,\"a\nb\"\n", "t_s,note\r1,2\r3,4\r",
                                 "t_s,note\n1,2\r3,4\n", "t_s;x\n1;2,5\n"}) {
    EXPECT_FALSE(in_blocks(text, {}).value().has_value()) << text;
    EXPECT_TRUE(read_csv_text(text, "a.csv", kColumns).has_value()) << text;
  }
}

TEST(CsvBlocks, ALineThatNeverEndsIsLeft) {
  const std::string text = "t_s,note\n1,2\n2," + std::string(3 << 20U, 'x') + "\n";
  EXPECT_FALSE(in_blocks(text, {.threads = 1}).value().has_value());
  EXPECT_EQ(read_csv_text(text, "a.csv", kColumns).value().rows(), 2U);
}

using CsvFiles = DirectoryTest;

TEST_F(CsvFiles, TheHashIsThatOfWhatWasRead) {
  const std::string text = "t_s,z\n" + rows_of(0, 100'000, ".5");
  write_all(path("a.csv"), text);
  for (const int threads : {1, 3}) {
    note_input(path("a.csv"), "none");
    const auto bytes = InputBytes::open(path("a.csv")).value();
    ASSERT_TRUE(read_csv_blocks(bytes, kColumns, {}, {.bytes = 5000, .threads = threads}).value());
    EXPECT_EQ(input_file(path("a.csv")).value().sha256, sha256_hex(text));
  }
}

TEST_F(CsvFiles, PlacesAreFoundAgain) {
  write_all(path("a.csv"), "# c\nt_s,n,z\n1,\xC3\xBC,  2\n# c\n 3, a ,4\n");
  const auto table = read_csv(path("a.csv"), kColumns).value();
  const std::string file = path("a.csv").string();
  EXPECT_EQ(table.place(0, "z"), file + ":3:7");
  EXPECT_EQ(table.place(1, "t_s"), file + ":5:2");
  EXPECT_EQ(table.place(1, "z"), file + ":5:8");
  EXPECT_EQ(table.place(1, "x"), file + ":5:1");
  std::filesystem::remove(path("a.csv"));
  EXPECT_EQ(table.place(1, "z"), file + ":5:8");
}

TEST_F(CsvFiles, AFileThatShrinksIsAnError) {
  write_all(path("a.csv"), "t_s,z\n" + rows_of(0, 100'000, ".5"));
  const auto bytes = InputBytes::open(path("a.csv")).value();
  std::filesystem::resize_file(path("a.csv"), 100'000);
  EXPECT_THAT(faults_of(read_csv(bytes, kColumns)), ElementsAre(HasSubstr("became shorter")));
}

TEST_F(CsvFiles, AFileThatIsWrittenToMeanwhileIsAnError) {
  write_all(path("a.csv"), "t_s,z\n" + rows_of(0, 1000, ".5"));
  const auto bytes = InputBytes::open(path("a.csv")).value();
  std::ofstream(path("a.csv"), std::ios::app) << "1000,1\n";
  EXPECT_THAT(faults_of(read_csv(bytes, kColumns)), ElementsAre(HasSubstr("changed while")));
}

TEST_F(CsvFiles, APipeIsRead) {
  const std::string text = "t_s,z\n" + rows_of(0, 100'000, ".5");
  ASSERT_EQ(::mkfifo(path("a.csv").c_str(), 0600), 0);
  std::thread writer([&] { write_all(path("a.csv"), text); });
  const auto table = read_csv(path("a.csv"), kColumns);
  writer.join();
  ASSERT_TRUE(table.has_value()) << to_text(table.error());
  EXPECT_EQ(table->rows(), 100'000U);
  EXPECT_THAT(table->place(99'999, "z"), HasSubstr("a.csv:100001:9"));
  EXPECT_EQ(input_file(path("a.csv")).value().sha256, sha256_hex(text));
}

}  // namespace
}  // namespace awmr::testing
