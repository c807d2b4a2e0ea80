/// ArduPilot's logs as text: the same signals as from the binary form of the drive, and all kinds
/// of invalid lines.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "awmr/trials/formats/log_formats.h"
#include "awmr/trials/read_trials.h"
#include "binary_text.h"
#include "trial_text.h"

namespace awmr::testing::dataflash_text_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAreArray;

const Wanted kAll = [](const std::string&) { return true; };

const std::string kFormats =
    "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
    "FMT, 130, 44, FMTU, QBNN, TimeUS,FmtType,UnitIds,MultIds\n"
    "FMT, 10, 15, RCOU, QHH, TimeUS,C1,C3\n"
    "FMT, 11, 18, IMU, QBhf, TimeUS,I,T,GyrZ\n"
    "FMT, 12, 21, GPS, QLLc, TimeUS,Lat,Lng,Crs\n"
    "FMT, 13, 67, MSG, Z, Message\n"
    "FMTU, 1, 11, s#OE, F---\n";

Result<Signals> read(const std::string& text) { return read_dataflash_text(text, "a.log", kAll); }

std::string binary_imu(std::uint64_t time_us, std::uint8_t instance, float rate) {
  return dataflash_record(11, le(time_us) + le(instance) + le(std::int16_t{25}) + le(rate));
}

/// Times and values by signal name.
using Columns =
    std::map<std::string, std::pair<std::vector<std::int64_t>, std::vector<double>>, std::less<>>;
Columns columns_of(const Signals& signals) {
  Columns all;
  for (const Topic& topic : signals.topics) {
    for (std::size_t i = 0; i < topic.columns.size(); ++i) {
      all[signals.header[topic.columns[i]]] = {topic.time_ns, topic.values[i]};
    }
  }
  return all;
}

TEST(DataflashText, HasTheSignalsOfTheSameDriveInTheBinaryForm) {
  std::string binary = dataflash_format(130, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds") +
                       dataflash_format(10, 15, "RCOU", "QHH", "TimeUS,C1,C3") +
                       dataflash_format(11, 18, "IMU", "QBhf", "TimeUS,I,T,GyrZ") +
                       dataflash_format(12, 21, "GPS", "QLLc", "TimeUS,Lat,Lng,Crs") +
                       dataflash_record(130, le(std::uint64_t{1}) + "\x0B" + padded("s#OE", 16) +
                                                 padded("F---", 16));
  std::string text = kFormats;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const std::uint64_t time_us = 1000 + 20'000 * i;
    const auto pulse = static_cast<std::uint16_t>(1500 + i);
    const float rate = 0.03F * static_cast<float>(i);
    binary += dataflash_record(10, le(time_us) + le(pulse) + le(std::uint16_t{1600}));
    binary += binary_imu(time_us + 100, 0, rate) + binary_imu(time_us + 100, 1, -rate);
    binary += dataflash_record(12, le(time_us + 200) + le(std::int32_t(481234567 + int(i))) +
                                       le(std::int32_t{-112345678}) + le(std::int16_t{-4500}));
    text += fmt::format("RCOU, {}, {}, 1600\n", time_us, pulse);
    text += fmt::format("IMU, {0}, 0, 25, {1}\nIMU, {0}, 1, 25, {2}\n", time_us + 100, double(rate),
                        -double(rate));
    text +=
        fmt::format("GPS, {}, {}, -11.2345678, -45\n", time_us + 200, 1e-7 * (481234567 + int(i)));
  }
  const auto of_text = read(text);
  const auto of_binary = read_dataflash(binary, "a.bin", kAll);
  ASSERT_TRUE(of_text) << to_text(of_text.error());
  ASSERT_TRUE(of_binary) << to_text(of_binary.error());
  EXPECT_THAT(of_text->header, UnorderedElementsAreArray(of_binary->header));
  const Columns a = columns_of(*of_text), b = columns_of(*of_binary);
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, signal] : b) {
    ASSERT_TRUE(a.count(name)) << name;
    EXPECT_EQ(a.at(name).first, signal.first) << name;
    for (std::size_t i = 0; i < signal.second.size(); ++i) {
      EXPECT_NEAR(a.at(name).second[i], signal.second[i], 1e-12) << name;
    }
  }
  EXPECT_THAT(of_text->notes, IsEmpty());
}

TEST(DataflashText, IsRecognisedByItsFirstLine) {
  EXPECT_TRUE(is_dataflash_text(kFormats));
  EXPECT_TRUE(is_dataflash_text("FMT,128,89,FMT,BBnNZ,Type\n"));
  EXPECT_FALSE(is_dataflash_text("FMT\n"));
  EXPECT_FALSE(is_dataflash_text("FMTU, 1\n"));
  EXPECT_FALSE(is_dataflash_text("t_s,FMT\n"));
  EXPECT_FALSE(is_dataflash_text(""));
}

TEST(DataflashText, IncompleteLinesAreSkippedAndNoted) {
  const auto signals = read(kFormats +
                            "RCOU, 1000, 1500, 1600\nRCOU, 2000, 1500\nWHAT, 1, 2\n"
                            "MSG, hello, world\nIMU, 1, x, 2, 3\nRCOU, 3000, 1501, 16");
  ASSERT_TRUE(signals) << to_text(signals.error());
  EXPECT_THAT(columns_of(*signals)["RCOU.C1"].second, ElementsAre(1500.0));
  ASSERT_EQ(signals->notes.size(), 1U);
  EXPECT_EQ(signals->notes[0].code, "log-damaged");
  EXPECT_THAT(signals->notes[0].message, StartsWith("4 of 13 lines"));
  const std::string whole = kFormats + "RCOU, 1000, 1500, 1600\n";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_TRUE(read(whole.substr(0, size))) << size;
  }
}

TEST(DataflashText, RefusesMalformedContentWithItsLine) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"FMT, 10, 15, RCOU, QHHH, TimeUS,C1,C3\n", "a.log:1: RCOU has 4 fields and 3 names"},
      {"FMT, 10, 16, RCOU, QHH, TimeUS,C1,C3\n",
       "declares 16 bytes, but header and fields have 15"},
      {"FMT, 10, 15, RCOU, Q?H, TimeUS,C1,C3\n", "unknown kind '?'"},
      {"FMT, 300, 15, RCOU, QHH, TimeUS,C1,C3\n", "a.log:1: invalid format line"},
      {"FMT, 10\n", "a.log:1: invalid format line"},
      {kFormats + "FMT, 10, 15, RCOU, QHH, TimeUS,C1,C4\n",
       "a.log:8: a second definition (FMT "
       "line)"},
      {kFormats + "RCOU, 99999999999999999999, 1, 2\n", "an invalid time"},
      {kFormats + "RCOU, -5, 1, 2\n", "a.log:8: a record of RCOU has an invalid time"},
      {kFormats + "RCOU, 1000, 1500, full\n", "a.log:8: RCOU.C3 is not a number: full"}};
  for (const auto& [text, words] : cases) {
    const auto signals = read(text);
    ASSERT_FALSE(signals) << words;
    EXPECT_THAT(to_text(signals.error()), HasSubstr(words));
  }
}

TEST(DataflashText, IsReadAsALog) {
  std::string text = kFormats;
  for (int i = 0; i < 60; ++i) {
    if (i % 3 == 0) text += fmt::format("RCOU, {}, 1600, 1550\r\n", 50'000 * i);
    text += fmt::format("IMU, {}, 0, 25, {}\r\n", 50'000 * i + 100, 0.1 + 0.001 * i * i);
  }
  const TrialOptions options{.columns = {*parse_column("force_left=(RCOU.C3 - 1500)/500"),
                                         *parse_column("force_right=(RCOU.C3 - 1500)/500"),
                                         *parse_column("steering_deg=0"),
                                         *parse_column("yaw_rate_radps=-IMU.GyrZ")}};
  const auto read_as_log = accepted(read_log, text, options);
  EXPECT_EQ(read_as_log.set[LogChannel::kYawRate]->fresh_count, 60);
  EXPECT_NEAR(read_as_log.set[LogChannel::kYawRate]->value[1], -0.1, 1e-12);
  EXPECT_NEAR(read_as_log.set.force_left[5], 0.1, 1e-12);
}

}  // namespace
}  // namespace awmr::testing::dataflash_text_test
