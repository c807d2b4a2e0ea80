/// Time columns with other names, in other units and as dates.
#include "awmr/core/csv/time_column.h"

#include <gmock/gmock.h>

#include "core/csv_text.h"
#include "core/faults.h"

namespace awmr::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::vector<CsvColumn> kLog = {{"t_s"}, {"v", false}};

std::string meaning_of(const std::vector<std::string>& header,
                       const std::vector<std::string>& samples = {}) {
  const auto time = find_time(header, samples);
  if (!time) return "refused: " + time.error();
  return *time ? (*time)->expression : "";
}

TEST(FindTime, AcceptsAnUnambiguousUnit) {
  EXPECT_EQ(meaning_of({"v", "time_ms"}), "`time_ms`*0.001");
  EXPECT_EQ(meaning_of({"t_us"}), "`t_us`*1e-06");
  EXPECT_EQ(meaning_of({"__time", "/odom/v"}), "`__time`") << "PlotJuggler's";
  EXPECT_EQ(meaning_of({"Time [ns]"}), "`Time [ns]`*1e-09");
  EXPECT_EQ(meaning_of({"header.stamp (us)"}), "`header.stamp (us)`*1e-06");
  EXPECT_EQ(meaning_of({"timestamp_seconds"}), "`timestamp_seconds`*1");
}

TEST(FindTime, TakesSecondsWithTheirNanoseconds) {
  EXPECT_EQ(meaning_of({"v", "header.stamp.sec", "header.stamp.nanosec"}),
            "`header.stamp.sec` + `header.stamp.nanosec`*1e-9");
  EXPECT_EQ(meaning_of({"secs", "nsecs"}), "`secs` + `nsecs`*1e-9");
  EXPECT_EQ(meaning_of({"stamp_sec", "stamp_nsec"}), "`stamp_sec` + `stamp_nsec`*1e-9");
}

TEST(FindTime, TakesNoNameWithoutAUnit) {
  for (const char* name : {"time", "t", "timestamp", "ms", "elapsed_s", "time_min", "settime_ms",
                           "sec", "time_ms_since", "stop_time_s", "gps_time_us"}) {
    EXPECT_EQ(meaning_of({name}, {"17"}), "") << name;
  }
}

TEST(FindTime, TakesSecondsSince1970WithTheirFractionWhereThereIsNoOtherTime) {
  EXPECT_EQ(meaning_of({"timestamp", "ATT.Roll"}, {"1700000000.25000000", ""}), "`timestamp`");
  EXPECT_EQ(meaning_of({"timestamp", "v"}, {"1700000000", "1"}),
            "");  // could also be microseconds
  EXPECT_EQ(meaning_of({"timestamp", "v"}, {"12.5", "1"}), "");
  EXPECT_EQ(meaning_of({"speed", "v"}, {"1700000000.5", "1"}), "");
  EXPECT_EQ(meaning_of({"timestamp", "time_ms"}, {"1700000000.5", "3"}), "`time_ms`*0.001");
}

TEST(FindTime, RefusesTwoPossibleTimes) {
  EXPECT_THAT(meaning_of({"time_ms", "gps_timestamp_us"}),
              AllOf(HasSubstr("refused"), HasSubstr("\"time_ms\" in ms"),
                    HasSubstr("\"gps_timestamp_us\" in us")));
  EXPECT_THAT(meaning_of({"a.sec", "a.nanosec", "b.sec", "b.nanosec"}), HasSubstr("refused"));
  EXPECT_THAT(meaning_of({"time_s", "time_ns"}), HasSubstr("refused"))
      << "time_s can have a fraction, so time_ns is a second time and not its fraction";
}

TEST(FindTime, TakesDates) {
  EXPECT_EQ(meaning_of({"v", "time"}, {"1", "2026-11-21T17:48:06Z"}), "time");
  EXPECT_EQ(meaning_of({"Date"}, {"2026-11-21 17:48"}), "Date");
  EXPECT_EQ(meaning_of({"name"}, {"2026-11-21 17:48"}), "");
}

TEST(SecondsOfDate, IsWhatTheCalendarSays) {
  // Expected value by: date -u -d 2026-11-21T17:48:06Z +%s
  EXPECT_EQ(seconds_of_date("2026-11-21T17:48:06Z"), 1795283286.0);
  EXPECT_EQ(seconds_of_date("1970-01-01 00:00"), 0.0);
  EXPECT_EQ(seconds_of_date("2024-02-29T00:00:00+00:00"), 1709164800.0);
  EXPECT_EQ(seconds_of_date("1970-01-01T01:00:00+01:00"), 0.0);
  EXPECT_EQ(seconds_of_date("1969-12-31T19:00:00-0500"), 0.0);
  EXPECT_NEAR(*seconds_of_date("1970-01-01T00:00:01.250"), 1.25, 1e-12);
  EXPECT_NEAR(*seconds_of_date("1970-01-01T00:00:01,5Z"), 1.5, 1e-12);
}

TEST(SecondsOfDate, RefusesEverythingElse) {
  for (const char* text :
       {"", "2026", "2026-11-21", "2026-13-01T00:00", "2026-02-29T00:00", "2026-11-21T24:00",
        "2026-11-21T17:60", "2026-11-21T17:48:60", "2026-11-21T17:48:06.", "2026-11-21T17:48Zx",
        "2026-11-21T17:48+15", "21.11.2026 17:48", "2026-11-21t17:48", "-026-11-21T17:48",
        "2026-11-21T17:48:06+1"}) {
    EXPECT_FALSE(seconds_of_date(text)) << text;
  }
}

TEST(CsvTime, IsConvertedAndNoted) {
  const auto table = read_text("time_ms,v\n0,1\n20,2\n", kLog);
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("t_s"), ElementsAre(0.0, 0.02));
  ASSERT_THAT(table->notes, SizeIs(1));
  EXPECT_EQ(table->notes[0].code, "time-column");
  EXPECT_THAT(table->notes[0].message, HasSubstr("\"time_ms\" in ms"));
}

TEST(CsvTime, OfAClockCountsFromTheFirstRow) {
  const auto pair =
      read_text("sec,nanosec,v\n1795283286,999000000,1\n1795283287,1000000,2\n", kLog);
  ASSERT_TRUE(pair) << to_text(pair.error());
  // A double near 1.8e9 s has steps of 2.4e-7 s.
  EXPECT_NEAR(pair->column("t_s")[1], 0.002, 5e-7);
  EXPECT_EQ(pair->column("t_s")[0], 0.0);
  const auto dates = read_text(
      "time;v\n2026-11-21T17:48:06,25Z;1\n2026-11-21T17:48:07Z;2\n2026-11-21T18:48:08+01:00;3\n",
      kLog);
  ASSERT_TRUE(dates) << to_text(dates.error());
  EXPECT_THAT(dates->column("t_s"), ElementsAre(0.0, 0.75, 1.75));
  EXPECT_THAT(dates->notes.back().message, HasSubstr("counted from the first row"));
}

TEST(CsvTime, AMappingMayNameAColumnOfDates) {
  const auto table = read_text("when,v\n2026-11-21T17:48:06Z,1\n2026-11-21T17:48:07Z,2\n", kLog,
                               {*parse_column("t_s=when")});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("t_s"), ElementsAre(0.0, 1.0));
}

TEST(CsvTime, TheColumnOfTheContractComesFirst) {
  const auto table = read_text("time_ms,t_s\n5,1\n6,2\n", kLog);
  ASSERT_TRUE(table);
  EXPECT_THAT(table->column("t_s"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(table->notes, IsEmpty());
}

TEST(CsvTime, RefusesAmbiguousTimes) {
  EXPECT_THAT(faults_of(read_text("time,v\n0,1\n", kLog)),
              ElementsAre(HasSubstr("the column t_s is missing")));
  EXPECT_THAT(faults_of(read_text("time_ms,t_us,v\n0,0,1\n", kLog)),
              ElementsAre(AllOf(HasSubstr("the time may be"), HasSubstr("column t_s=EXPRESSION"))));
  EXPECT_THAT(faults_of(read_text("sec,nanosec\n0,500000000\n0.5,1500000000\n", kLog)),
              ElementsAre(HasSubstr("nanoseconds below 1e9, found 0.5 and 1500000000")));
  EXPECT_THAT(faults_of(read_text("time,v\n2026-11-21T17:48:06Z,1\nnoon,2\n", kLog)),
              ElementsAre(AllOf(HasSubstr("a.csv:3:1"), HasSubstr("expected a date"))));
}

}  // namespace
}  // namespace awmr::testing
