/// CSV formats that the reader accepts.
#include "awmr/core/csv.h"

#include <gmock/gmock.h>

#include "awmr/core/column_mapping.h"
#include "core/csv_text.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

const std::vector<CsvColumn> kSurge = {{"tau_speed"}, {"speed_mps"}};

void expect_two_rows(const Result<CsvTable>& table) {
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("tau_speed"), ElementsAre(0.5, 2.0));
  EXPECT_THAT(table->column("speed_mps"), ElementsAre(0.25, 1.66));
}

TEST(CsvWithoutAHeader, IsReadByThePositionsThatAreMapped) {
  const std::vector<CsvColumn> columns{{"t_s"}, {"v"}};
  const std::vector<ColumnMapping> mappings{*parse_column("t_s=column_1"),
                                            *parse_column("v=column_3*0.5")};
  for (const char* text :
       {"0,9,4\n1,9,6\n", "0;9;4,0\n1;9;6,0\n", "# by hand\n0\t9\t4\n1\t9\t6\n"}) {
    const auto table = read_text(text, columns, mappings);
    ASSERT_TRUE(table) << text << to_text(table.error());
    EXPECT_THAT(table->column("t_s"), ::testing::ElementsAre(0.0, 1.0)) << text;
    EXPECT_THAT(table->column("v"), ::testing::ElementsAre(2.0, 3.0)) << text;
  }
  const auto broken = read_text("0,9,4\n1,9,x\n", columns, mappings);
  ASSERT_FALSE(broken);
  EXPECT_THAT(to_text(broken.error()), ::testing::HasSubstr(":2:5"));
  const auto few = read_text("0,9\n1,9\n", columns, mappings);
  ASSERT_FALSE(few);
  EXPECT_THAT(to_text(few.error()), ::testing::HasSubstr("column_3"));
  const auto unmapped = read_text("0,9\n1,9\n", columns);
  ASSERT_FALSE(unmapped);
  EXPECT_THAT(to_text(unmapped.error()), ::testing::HasSubstr("column_1"));
}

TEST(Csv, ReadsCommas) {
  expect_two_rows(read_text("tau_speed,speed_mps\n0.5,0.25\n2,1.66\n", kSurge));
}

TEST(Csv, ReadsSemicolons) {
  expect_two_rows(read_text("tau_speed;speed_mps\n0.5;0.25\n2;1.66\n", kSurge));
}

TEST(Csv, ReadsTabs) {
  expect_two_rows(read_text("tau_speed\tspeed_mps\n0.5\t0.25\n2\t1.66\n", kSurge));
}

TEST(Csv, DetectsTheDelimiterThatFindsTheColumnsRequested) {
  // The header has four commas and two semicolons, so the comma is the separator.
  expect_two_rows(
      read_text("note, a, b, c, d;tau_speed;speed_mps\nx;0.5;0.25\ny;2;1.66\n", kSurge));
}

TEST(Csv, ReadsWindowsAndOldMacintoshLineEnds) {
  for (const std::string end : {"\r\n", "\r"}) {
    const auto table =
        read_text("tau_speed,speed_mps" + end + "0.5,0.25" + end + "2,1.66" + end, kSurge);
    expect_two_rows(table);
    EXPECT_EQ(table->line(1), 3);
  }
}

TEST(Csv, ReadsALastLineWithoutAnEnd) {
  expect_two_rows(read_text("tau_speed,speed_mps\n0.5,0.25\n2,1.66", kSurge));
}

/// Returns the notes of a table, one per line, as `CODE@LINE: MESSAGE`.
std::string notes_of(const Result<CsvTable>& table) {
  std::string text;
  for (const CsvNote& note : table->notes) {
    text += note.code + "@" + std::to_string(note.line) + ": " + note.message + "\n";
  }
  return text;
}

TEST(Csv, ReadsAndReportsDecimalCommas) {
  for (const std::string d : {";", "\t"}) {
    const auto table =
        read_text("tau_speed" + d + "speed_mps\n0,5" + d + "2,5e-1\n2" + d + "+1,66\n", kSurge);
    expect_two_rows(table);
    EXPECT_THAT(notes_of(table), HasSubstr("decimal commas"));
  }
}

TEST(Csv, ThreeDecimalsAreDecimalsIfAnotherCellShowsIt) {
  const auto table = read_text("tau_speed;speed_mps\n0,500;0,250\n2,000;1,660\n", kSurge);
  expect_two_rows(table);
}

TEST(Csv, ReportsNothingForAPlainFile) {
  EXPECT_EQ(notes_of(read_text("\xEF\xBB\xBFtau_speed,speed_mps\r\n1,2\r\n", kSurge)), "");
}

TEST(Csv, ReadsAHeaderBehindAHash) {
  for (const std::string header :
       {"# tau_speed,speed_mps\n", "# run of May\n#tau_speed,speed_mps\n",
        "## tau_speed , speed_mps\n\n"}) {
    const auto table = read_text(header + "0.5,0.25\n2,1.66\n", kSurge);
    expect_two_rows(table);
    EXPECT_THAT(notes_of(table), HasSubstr("names after #"));
  }
  const auto commas = read_text("# tau_speed;speed_mps\n0,5;0,25\n2;1,66\n", kSurge);
  expect_two_rows(commas);
  EXPECT_THAT(commas->header_place(), EndsWith("a.csv:1:1"));
  EXPECT_EQ(commas->line(0), 2);
}

TEST(Csv, ACommentAboveAHeaderIsOnlyAComment) {
  expect_two_rows(
      read_text("# speed_mps,tau_speed\ntau_speed,speed_mps\n0.5,0.25\n2,1.66\n", kSurge));
}

TEST(Csv, SkipsAByteOrderMarkAndDoesNotCountIt) {
  const auto table = read_text("\xEF\xBB\xBFtau_speed,speed_mps\n0.5,0.25\n2,1.66\n", kSurge);
  expect_two_rows(table);
  EXPECT_THAT(table->header_place(), EndsWith("a.csv:1:1"));
}

TEST(Csv, SkipsCommentsAndBlankLinesButCountsThem) {
  const auto table = read_text(
      "# a trial\n\ntau_speed,speed_mps\n  # slow, \"open quote\n0.5,0.25\n \t \n2,1.66\n", kSurge);
  expect_two_rows(table);
  EXPECT_THAT(table->header_place(), EndsWith("a.csv:3:1"));
  EXPECT_EQ(table->line(0), 5);
  EXPECT_EQ(table->line(1), 7);
}

TEST(Csv, ReadsQuotedCellsWithDelimitersQuotesAndLineBreaks) {
  const auto table = read_text(
      "\"tau_speed\",\"a \"\"note\"\", b\",speed_mps\n\"0.5\",\"x\ny, z\",0.25\n 2 ,\"#\", "
      "\"1.66\" \n",
      kSurge);
  expect_two_rows(table);
  EXPECT_EQ(table->line(0), 2);
  EXPECT_EQ(table->line(1), 4);
}

TEST(Csv, FindsAColumnWhoseNameHoldsAQuote) {
  const auto table = read_text("\"the \"\"W\"\"\",b\n1,2\n", {{"the \"W\""}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("the \"W\""), ElementsAre(1.0));
}

TEST(Csv, ReadsEveryDecimalForm) {
  const auto table = read_text(
      "x\n+1.5\n-1.5\n.5\n5.\n+.5\n1e3\n1E-3\n1e+3\n-0\n4.9406564584124654e-324\n", {{"x"}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("x"),
              ElementsAre(1.5, -1.5, 0.5, 5.0, 0.5, 1000.0, 0.001, 1000.0, 0.0, 5e-324));
}

TEST(Csv, IgnoresExtraColumnsWhateverTheyHold) {
  expect_two_rows(
      read_text("note,tau_speed,x,x,speed_mps,\n,0.5,,nan,0.25,\nb,2,1,1,1.66,\n", kSurge));
}

TEST(Csv, AnOptionalColumnMayBeAbsent) {
  const auto table = read_text("tau_speed\n1\n", {{"tau_speed"}, {"elapsed_s", false}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_TRUE(table->has("tau_speed"));
  EXPECT_FALSE(table->has("elapsed_s"));
}

TEST(Csv, PlacesACellByLineAndCharacter) {
  // The umlaut is two bytes and one character.
  const auto table = read_text("note,tau_speed,speed_mps\n\xC3\xBC,  0.5,0.25\n", kSurge);
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->place(0, "tau_speed"), EndsWith("a.csv:2:5"));
  EXPECT_THAT(table->place(0, "speed_mps"), EndsWith("a.csv:2:9"));
  EXPECT_THAT(table->place(0, "elapsed_s"), EndsWith("a.csv:2:1"));
}

TEST(Csv, ReadsAndReportsVerticalBars) {
  const auto table = read_text("tau_speed|speed_mps\n0,5|0,25\n2|1,66\n", kSurge);
  expect_two_rows(table);
  EXPECT_THAT(notes_of(table), HasSubstr("vertical bars"));
}

TEST(Csv, ReadsAMinusSignOfUnicode) {
  const auto table = read_text(
      "a\n\xE2\x88\x92"
      "0.5\n1e\xE2\x88\x92"
      "2\n",
      {{"a"}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("a"), ElementsAre(-0.5, 0.01));
}

TEST(Csv, SkipsAndReportsLinesAboveTheHeader) {
  for (const std::string above :
       {"=~=~=~=~=~= PuTTY log 2026.01.31 12:00:00 =~=~=~=~=~=\n", "sep=;\n", "\"sep=,\"\n",
        "Robot 5\n", "Robot 5; May 2026\nfirst floor\n", "% recorded by MATLAB\n"}) {
    const auto table = read_text(above + "tau_speed;speed_mps;run\n0.5;0.25;1\n2;1.66;1\n", kSurge);
    expect_two_rows(table);
    EXPECT_THAT(notes_of(table), HasSubstr("above the header")) << above;
  }
}

TEST(Csv, ATitleAboveForeignNamesIsLeftOut) {
  const auto table =
      read_text("Robot 5\nthrust,v\n0.5,0.25\n2,1.66\n", kSurge,
                {*parse_column("tau_speed=thrust*1"), *parse_column("speed_mps=v*1")});
  expect_two_rows(table);
}

TEST(Csv, ReadsAPipe) {
  const auto table = read_csv("/dev/null", kSurge);
  ASSERT_FALSE(table);
  EXPECT_THAT(table.error().faults[0].message, ::testing::HasSubstr("the file is empty"));
}

TEST(Csv, AMappingTakesAnotherNameAndUnit) {
  const auto table = read_text("t_s,W (IMU)\n0,10\n1,-20\n", {{"t_s"}, {"yaw_rate_radps"}},
                               {{"yaw_rate_radps", "W (IMU)", 0.5, 1.0}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("yaw_rate_radps"), ElementsAre(6.0, -9.0));
}

TEST(Csv, AMappingHasPriorityOverAColumnOfTheSameName) {
  const auto table = read_text("x,y\n1,2\n", {{"x"}}, {{"x", "y", 1.0, 0.0}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("x"), ElementsAre(2.0));
}

TEST(Csv, AMappingWithoutItsSourceLeavesAColumnOfTheNameAsItIs) {
  const auto table = read_text("x\n3\n", {{"x"}}, {{"x", "y", 100.0, 0.0}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("x"), ElementsAre(3.0));
}

TEST(Csv, ARunMayLackAnOptionalValueWhateverTheOthersHave) {
  const std::vector<CsvColumn> columns = {{"a"}, {"b", false, EmptyCells::kOptional}};
  const auto table = read_text("a,b\n1,5\n2,\n3,7\n4,8\n5,9\n", columns);
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_EQ(table->rows(), 5U);
  EXPECT_THAT(table->present("b"), ElementsAre(true, false, true, true, true));
  EXPECT_TRUE(table->notes.empty());
  // A column without any value does not count; no row is dropped for it.
  const auto without = read_text("a,b\n1,\n2,\n", columns);
  ASSERT_TRUE(without) << to_text(without.error());
  EXPECT_FALSE(without->has("b"));
  EXPECT_EQ(without->rows(), 2U);
  // A missing required column is still reported as a fault.
  EXPECT_FALSE(read_text("a,b\n1,5\n,6\n", columns));
}

TEST(Csv, AFormulaOfAnOptionalColumnTakesTheCellsOfItsOwnRow) {
  const auto table =
      read_text("a,p,q\n1,2,3\n2,,4\n3,5,\n", {{"a"}, {"b", false, EmptyCells::kOptional}},
                {*parse_column("b=p*q")});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->present("b"), ElementsAre(true, false, false));
  EXPECT_EQ(table->column("b")[0], 6.0);
}

TEST(Csv, OneSourceMayServeTwoColumns) {
  const auto table =
      read_text("w\n4\n", {{"a"}, {"b"}}, {{"a", "w", 1.0, 0.0}, {"b", "w", 0.5, 0.0}});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("a"), ElementsAre(4.0));
  EXPECT_THAT(table->column("b"), ElementsAre(2.0));
}

}  // namespace
}  // namespace awmr::testing
