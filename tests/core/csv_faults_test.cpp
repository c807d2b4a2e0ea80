/// Errors in CSV files: their place, message and remedy.
#include <gmock/gmock.h>

#include "awmr/core/csv/raw_table.h"
#include "core/csv_text.h"
#include "core/faults.h"

namespace awmr::testing::csv_faults_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::vector<CsvColumn> kSurge = {{"tau_speed"}, {"speed_mps"}};

std::vector<std::string> faults(std::string_view text,
                                const std::vector<ColumnMapping>& mappings = {}) {
  return faults_of(read_text(text, kSurge, mappings));
}

/// Returns the faults of a file whose only row has this cell in the column speed_mps.
std::vector<std::string> cell_faults(const std::string& cell, char delimiter = ',') {
  const std::string d(1, delimiter);
  return faults("tau_speed" + d + "speed_mps\n1" + d + cell + "\n");
}

TEST(CsvFaults, EmptyFile) {
  EXPECT_THAT(faults(""), ElementsAre(AllOf(StartsWith("a.csv: "), HasSubstr("is empty"))));
}

TEST(CsvFaults, OnlyAByteOrderMarkOrCommentsIsNoHeader) {
  EXPECT_THAT(faults("\xEF\xBB\xBF"), ElementsAre(HasSubstr("no header row")));
  EXPECT_THAT(faults("# nothing\n\n"), ElementsAre(HasSubstr("no header row")));
}

TEST(CsvFaults, JoinedSignalsWithoutRows) {
  EXPECT_THAT(faults_of(table_of({.file = "a.mcap", .joined = true}, {}, {}, {})),
              ElementsAre(AllOf(StartsWith("a.mcap:1:1: "),
                                HasSubstr("no row has a value of a command or measurement"))));
}

TEST(CsvFaults, HeaderWithoutRows) {
  EXPECT_THAT(faults("# c\ntau_speed,speed_mps\n"),
              ElementsAre(AllOf(StartsWith("a.csv:2:1: "), HasSubstr("no rows"))));
}

TEST(CsvFaults, RowsWithoutHeader) {
  EXPECT_THAT(
      faults("1,0.5\n2,1.2\n"),
      ElementsAre(AllOf(StartsWith("a.csv:1:1: "), HasSubstr("expected the columns' names"))));
}

TEST(CsvFaults, MissingFileAndDirectory) {
  EXPECT_THAT(faults_of(read_csv("/no/such/a.csv", kSurge)),
              ElementsAre(AllOf(StartsWith("a.csv: "), HasSubstr("No such file"))));
  const auto directory = read_csv("/tmp", kSurge);
  EXPECT_THAT(faults_of(directory), ElementsAre(HasSubstr("is a directory")));
}

TEST(CsvFaults, MissingColumnNamesTheNearestOne) {
  EXPECT_THAT(faults("tau_sped,speed_mps\n1,0.5\n"),
              ElementsAre(AllOf(StartsWith("a.csv:1:1: "), HasSubstr("tau_speed is missing"),
                                HasSubstr("did you mean \"tau_sped\"?"))));
}

TEST(CsvFaults, MissingColumnWithNothingNearListsTheHeader) {
  EXPECT_THAT(faults("thrust,speed_mps\n1,0.5\n"),
              ElementsAre(AllOf(HasSubstr("the header has thrust, speed_mps"),
                                HasSubstr("column tau_speed=SOURCE"))));
}

TEST(CsvFaults, EveryMissingColumnAtOnce) { EXPECT_THAT(faults("a,b\n1,2\n"), SizeIs(2)); }

TEST(CsvFaults, MissingSourceOfAMappingIsNamed) {
  EXPECT_THAT(faults("tau_speed,V (m/s)\n1,0.5\n", {{"speed_mps", "v (m/s)", 1.0, 0.0}}),
              ElementsAre(AllOf(HasSubstr("\"v (m/s)\", mapped to speed_mps, is missing"),
                                HasSubstr("did you mean \"V (m/s)\"?"))));
}

TEST(CsvFaults, TwoMappingsForOneColumn) {
  EXPECT_THAT(faults("tau_speed,a,b\n1,2,3\n",
                     {{"speed_mps", "a", 1.0, 0.0}, {"speed_mps", "b", 1.0, 0.0}}),
              ElementsAre(HasSubstr("two mappings give the column speed_mps")));
}

TEST(CsvFaults, DuplicateColumnIsPlacedAtTheSecond) {
  EXPECT_THAT(faults("tau_speed,speed_mps,speed_mps\n1,2,3\n"),
              ElementsAre(AllOf(StartsWith("a.csv:1:21: "), HasSubstr("appears twice"))));
}

TEST(CsvFaults, RaggedRows) {
  EXPECT_THAT(
      faults("tau_speed,speed_mps\n1\n1,2,3\n1,2,\n"),
      ElementsAre(AllOf(StartsWith("a.csv:2:1: "), HasSubstr("1 cells, but the header has 2")),
                  AllOf(StartsWith("a.csv:3:5: "), HasSubstr("3 cells, but the header has 2")),
                  StartsWith("a.csv:4:5: ")));
}

TEST(CsvFaults, DecimalCommasInACommaFile) {
  EXPECT_THAT(faults("tau_speed,speed_mps\n0,5,1,25\n"), ElementsAre(HasSubstr("decimal commas")));
}

TEST(CsvFaults, DecimalCommaInAQuotedCellOfACommaFile) {
  EXPECT_THAT(cell_faults("\"-1,25e3\""), ElementsAre(HasSubstr("write -1.25e3 with a point")));
}

TEST(CsvFaults, DecimalCommasAndPointsInOneFile) {
  EXPECT_THAT(faults("tau_speed;speed_mps\n1;1,25\n1.5;2\n"),
              ElementsAre(AllOf(StartsWith("a.csv:2:3: "), HasSubstr("\"1,25\""),
                                HasSubstr("\"1.5\" with a point in line 3"))));
}

TEST(CsvFaults, AmbiguousThousandsSeparators) {
  EXPECT_THAT(faults("tau_speed;speed_mps\n1;1,250\n2;-12,500\n"),
              ElementsAre(AllOf(StartsWith("a.csv:2:3: "), HasSubstr("thousands separator"))));
  EXPECT_THAT(cell_faults("1,2,5", ';'), ElementsAre(HasSubstr("expected a number")));
}

TEST(CsvFaults, EmptyCells) {
  EXPECT_THAT(cell_faults(""),
              ElementsAre(AllOf(StartsWith("a.csv:2:3: "), HasSubstr("is empty"))));
  EXPECT_THAT(cell_faults("  "), ElementsAre(StartsWith("a.csv:2:3: ")));
  EXPECT_THAT(cell_faults("\"\""), ElementsAre(HasSubstr("is empty")));
  EXPECT_THAT(faults("tau_speed\tspeed_mps\n\t\n"), SizeIs(2));
}

TEST(CsvFaults, NaN) {
  for (const char* cell : {"nan", "NaN", "-nan", "+NAN", "nan(1)"}) {
    EXPECT_THAT(cell_faults(cell), ElementsAre(AllOf(StartsWith("a.csv:2:3: column speed_mps: "),
                                                     HasSubstr("without a measured value"))))
        << cell;
  }
}

TEST(CsvFaults, Infinity) {
  for (const char* cell : {"inf", "-inf", "+Inf", "Infinity", "-INFINITY"}) {
    EXPECT_THAT(cell_faults(cell), ElementsAre(HasSubstr("without a finite value"))) << cell;
  }
}

TEST(CsvFaults, Hexadecimal) {
  for (const char* cell : {"0x1F", "-0X2", "0x1p3"}) {
    EXPECT_THAT(cell_faults(cell), ElementsAre(HasSubstr("hexadecimal"))) << cell;
  }
}

TEST(CsvFaults, Text) {
  for (const char* cell : {"fast", "--1", "+-1", "-+1", "++1", "+", "-", ".", "e5", "1e", "1..2",
                           "1 2", "1'000", "1e5.5", "=A1"}) {
    EXPECT_THAT(cell_faults(cell),
                ElementsAre(AllOf(StartsWith("a.csv:2:3: "), HasSubstr("expected a number, found"),
                                  HasSubstr(std::string("\"").append(cell).append("\"")))))
        << cell;
  }
}

TEST(CsvFaults, UnitBehindTheNumber) {
  EXPECT_THAT(cell_faults("1.5 m/s"), ElementsAre(HasSubstr("its unit in the column's name")));
}

TEST(CsvFaults, NumbersOutOfRange) {
  EXPECT_THAT(cell_faults("1e999"), ElementsAre(HasSubstr("out of range")));
  EXPECT_THAT(cell_faults("-1e999"), ElementsAre(HasSubstr("out of range")));
  EXPECT_THAT(cell_faults("1e-999"), ElementsAre(HasSubstr("out of range")));
  EXPECT_THAT(faults("tau_speed,v\n1,1e300\n", {{"speed_mps", "v", 1e10, 0.0}}),
              ElementsAre(HasSubstr("out of range after scaling")));
}

TEST(CsvFaults, QuoteThatIsNotClosed) {
  EXPECT_THAT(faults("tau_speed,speed_mps\n1,\"2\n3,4\n"),
              ElementsAre(AllOf(StartsWith("a.csv:2:3: "), HasSubstr("not closed"))));
  EXPECT_THAT(faults("tau_speed,\"speed_mps\n1,2\n"),
              ElementsAre(AllOf(StartsWith("a.csv:1:11: "), HasSubstr("not closed"))));
}

TEST(CsvFaults, TextAfterAQuotedCellAndOnWithTheNextLine) {
  EXPECT_THAT(
      faults("tau_speed,speed_mps\n\"1\"0,2\nx,4\n"),
      ElementsAre(AllOf(StartsWith("a.csv:2:1: "), HasSubstr("quote inside a quoted cell twice")),
                  StartsWith("a.csv:3:1: ")));
}

TEST(CsvFaults, LineNumbersGoOnAfterALineBreakInAQuotedCell) {
  EXPECT_THAT(
      faults("note,tau_speed,speed_mps\n\"a\nb\",x,y\n\"c\",1,z\n"),
      ElementsAre(StartsWith("a.csv:3:4: "), StartsWith("a.csv:3:6: "), StartsWith("a.csv:4:7: ")));
}

TEST(CsvFaults, BinaryAndUtf16) {
  using namespace std::string_view_literals;
  EXPECT_THAT(faults("\xFF\xFEt\0a\0u\0"sv), ElementsAre(HasSubstr("save it as UTF-8")));
}

TEST(CsvFaults, EveryFaultAtOnceHeaderAndRows) {
  EXPECT_THAT(faults("tau_speed,sped_mps\nx,1\n1\ny,2\n"),
              ElementsAre(StartsWith("a.csv:1:1: "), StartsWith("a.csv:2:1: "),
                          StartsWith("a.csv:3:1: "), StartsWith("a.csv:4:1: ")));
}

TEST(CsvFaults, ReadingEndsAfterAHundredFaultsAndOneOfACauseIsShown) {
  std::string text = "tau_speed,speed_mps\n";
  for (int i = 0; i < 100000; ++i) text += "1,x\n";
  const auto table = read_text(text, kSurge);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().faults.size(), 100U);
  const std::string shown = to_text(table.error());
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 1);
  EXPECT_THAT(shown, AllOf(HasSubstr("a.csv:2:3: "), HasSubstr("at least 99 more")));
}

TEST(CsvFaults, FaultsOfTwoCausesAreShownOnceEach) {
  std::string text = "tau_speed,speed_mps\n";
  for (int i = 0; i < 10; ++i) text += "1,12:30\n1,5,6\n";
  const auto table = read_text(text, kSurge);
  ASSERT_FALSE(table);
  const std::string shown = to_text(table.error());
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 2) << shown;
}

TEST(CsvFaults, UpToThreeFaultsOfACauseAreShownEach) {
  const auto table = read_text("tau_speed,speed_mps\nx,1\nx,1\nx,1\n", kSurge);
  ASSERT_FALSE(table);
  const std::string shown = to_text(table.error());
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 3) << shown;
}

TEST(CsvFaults, DecimalCommasBetweenCommasAreNamed) {
  EXPECT_THAT(faults("tau_speed,speed_mps\n0,2353,5,31\n"),
              ElementsAre(AllOf(StartsWith("a.csv:2:8: "), HasSubstr("decimal commas"))));
  EXPECT_THAT(faults("tau_speed,speed_mps\n1,0,5\n"),
              ElementsAre(AllOf(StartsWith("a.csv:2:5: "), HasSubstr("decimal commas"))));
}

TEST(CsvFaults, FilesOfOtherFormatsAreNamed) {
  for (const char* text :
       {"{\"t_s\": [0, 1]}\n", "{\n  \"a\": 1\n}\n", "[{\"t_s\": 0}]\n", "[\n1\n]\n"}) {
    EXPECT_THAT(faults(text), ElementsAre(AllOf(StartsWith("a.csv:1:1: "), HasSubstr("JSON"))))
        << text;
  }
  EXPECT_THAT(faults("<!DOCTYPE html>\n<html></html>\n"), ElementsAre(HasSubstr("HTML")));
  EXPECT_THAT(faults("<table><tr>\n"), ElementsAre(HasSubstr("HTML")));
  EXPECT_THAT(faults("PK\x03\x04...."), ElementsAre(HasSubstr("Excel")));
}

TEST(CsvFaults, CellsBetweenSpacesAreOneFault) {
  EXPECT_THAT(faults("tau_speed speed_mps\n1 0.5\n2 1.0\n"),
              ElementsAre(AllOf(StartsWith("a.csv:1:1: "), HasSubstr("spaces"))));
  EXPECT_THAT(faults("thrust  v\n1   0.5\n"), ElementsAre(HasSubstr("spaces")));
}

TEST(CsvFaults, BytesThatAreNotUtf8AreNamedWithTheirPlace) {
  EXPECT_THAT(faults("tau_speed,speed_mps,W\xE4rme\n1,2,3\n"),
              ElementsAre(AllOf(StartsWith("a.csv:1:21: "), HasSubstr("UTF-8"))));
  EXPECT_THAT(cell_faults("5\xB0"), ElementsAre(HasSubstr("UTF-8")));
}

TEST(CsvFaults, DatesAndClockTimesAreNamed) {
  for (const char* cell : {"2026-01-31", "31.01.2026", "1/31/26", "2026-01-31T12:00:00"}) {
    EXPECT_THAT(cell_faults(cell), ElementsAre(HasSubstr("a date;"))) << cell;
  }
  for (const char* cell : {"12:34", "9:05:07.25"}) {
    EXPECT_THAT(cell_faults(cell), ElementsAre(HasSubstr("a clock time;"))) << cell;
  }
}

TEST(CsvFaults, ALongCellIsCutBetweenCharacters) {
  std::string cell = "x";
  for (int i = 0; i < 50; ++i) cell += "\xC3\xBC";
  const auto texts = cell_faults(cell);
  ASSERT_THAT(texts, SizeIs(1));
  // A shown cell has at most 40 bytes: 1 + 2 * 19 = 39, because the 40th would be half a character.
  std::string expected = "\"x";
  for (int i = 0; i < 19; ++i) expected += "\xC3\xBC";
  EXPECT_THAT(texts[0], HasSubstr(expected + "...\""));
}

}  // namespace
}  // namespace awmr::testing::csv_faults_test
