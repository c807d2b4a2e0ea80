/// ArduPilot DataFlash: signals read, and all kinds of invalid files.
#include <gmock/gmock.h>

#include "awmr/trials/formats/log_formats.h"
#include "awmr/trials/read_trials.h"
#include "binary_text.h"
#include "trial_text.h"

namespace awmr::testing::dataflash_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Wanted kAll = [](const std::string&) { return true; };

std::string formats() {
  return dataflash_format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns") +
         dataflash_format(130, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds") +
         dataflash_format(10, 15, "RCOU", "QHH", "TimeUS,C1,C3") +
         dataflash_format(11, 18, "IMU", "QBhf", "TimeUS,I,T,GyrZ") +
         dataflash_format(12, 21, "GPS", "QLLc", "TimeUS,Lat,Lng,Crs") +
         dataflash_format(13, 67, "MSG", "Z", "Message") +
         dataflash_record(130,
                          le(std::uint64_t{1}) + "\x0B" + padded("s#OE", 16) + padded("F---", 16));
}

std::string imu(std::uint64_t time_us, std::uint8_t instance, float rate) {
  return dataflash_record(11, le(time_us) + le(instance) + le(std::int16_t{25}) + le(rate));
}

std::string small_log() {
  return formats() +
         dataflash_record(
             10, le(std::uint64_t{1000}) + le(std::uint16_t{1500}) + le(std::uint16_t{1600})) +
         imu(1100, 0, 0.5F) + imu(1100, 1, 0.75F) +
         dataflash_record(12, le(std::uint64_t{1200}) + le(std::int32_t{481234567}) +
                                  le(std::int32_t{-112345678}) + le(std::int16_t{-4500})) +
         dataflash_record(13, padded("hello", 64)) + imu(1300, 0, 1.0F);
}

Result<Signals> read(const std::string& bytes, const Wanted& wanted = kAll) {
  return read_dataflash(bytes, "a.bin", wanted);
}

TEST(Dataflash, FlattensRecordsAndTheirInstances) {
  const auto signals = read(small_log());
  ASSERT_TRUE(signals) << to_text(signals.error());
  EXPECT_THAT(signals->header,
              ElementsAre("RCOU.C1", "RCOU.C3", "IMU.T", "IMU.GyrZ", "IMU[1].T", "IMU[1].GyrZ",
                          "GPS.Lat", "GPS.Lng", "GPS.Crs", "FMTU.FmtType"));
  EXPECT_THAT(signals->topics[1].values[1], ElementsAre(0.5, 1.0));
  EXPECT_THAT(signals->topics[1].time_ns, ElementsAre(1'100'000, 1'300'000));
  EXPECT_THAT(signals->topics[2].values[1], ElementsAre(0.75));
  EXPECT_NEAR(signals->topics[3].values[0][0], 48.1234567, 1e-12);
  EXPECT_NEAR(signals->topics[3].values[1][0], -11.2345678, 1e-12);
  EXPECT_NEAR(signals->topics[3].values[2][0], -45.0, 1e-12);
  EXPECT_THAT(signals->notes, IsEmpty());
}

TEST(Dataflash, KeepsOnlyRequestedSignals) {
  const auto signals =
      read(small_log(), [](const std::string& name) { return name == "IMU.GyrZ"; });
  ASSERT_TRUE(signals);
  EXPECT_THAT(signals->topics[0].time_ns, IsEmpty());
  EXPECT_THAT(signals->topics[1].values, ElementsAre(ElementsAre(0.5, 1.0)));
}

TEST(Dataflash, LostBytesAndABrokenEndAreSkippedAndNoted) {
  const std::string whole = small_log();
  const auto cut = read(whole.substr(0, whole.size() - 5));
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->notes.at(0).code, "log-damaged");
  const auto lost = read(formats() + imu(1, 0, 1.0F) + imu(2, 0, 2.0F).substr(4) + "\xA3\x95" +
                         imu(3, 0, 3.0F) + dataflash_record(99, "unknown"));
  ASSERT_TRUE(lost) << to_text(lost.error());
  EXPECT_THAT(lost->topics[0].values[1], ElementsAre(1.0, 3.0));
  EXPECT_THAT(lost->notes, SizeIs(1));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_TRUE(read(whole.substr(0, size))) << size;
  }
}

TEST(Dataflash, RefusesMalformedContent) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {dataflash_format(10, 15, "RCOU", "QHHH", "TimeUS,C1,C3"), "4 fields and 3 names"},
      {dataflash_format(10, 16, "RCOU", "QHH", "TimeUS,C1,C3"),
       "declares 16 bytes, but header and fields have 15"},
      {dataflash_format(10, 0, "RCOU", "QHH", "TimeUS,C1,C3"), "declares 0 bytes"},
      {dataflash_format(10, 15, "RCOU", "Q?H", "TimeUS,C1,C3"), "unknown kind '?'"},
      {formats() + dataflash_format(10, 15, "RCOU", "QHH", "TimeUS,C1,C4"),
       "a second definition (FMT record)"},
      {formats() + imu(~std::uint64_t{0}, 0, 1.0F), "an invalid time"}};
  for (const auto& [bytes, words] : cases) {
    const auto signals = read(bytes);
    ASSERT_FALSE(signals) << words;
    EXPECT_THAT(to_text(signals.error()), HasSubstr(words));
  }
}

TEST(Dataflash, IsReadAsALog) {
  std::string bytes = formats();
  for (std::uint64_t i = 0; i < 60; ++i) {
    if (i % 3 == 0) {
      bytes +=
          dataflash_record(10, le(50'000 * i) + le(std::uint16_t{1600}) + le(std::uint16_t{1550}));
    }
    const auto x = static_cast<float>(i);
    bytes += imu(50'000 * i + 100, 0, 0.1F + 0.001F * x * x) + imu(50'000 * i + 100, 1, 9.0F);
  }
  const TrialOptions options{.columns = {*parse_column("force_left=(RCOU.C3 - 1500)/500"),
                                         *parse_column("force_right=(RCOU.C3 - 1500)/500"),
                                         *parse_column("steering_deg=0"),
                                         *parse_column("yaw_rate_radps=-IMU.GyrZ")}};
  const auto read = accepted(read_log, bytes, options);
  EXPECT_EQ(read.set[LogChannel::kYawRate]->fresh_count, 60);
  EXPECT_NEAR(read.set[LogChannel::kYawRate]->value[1], -0.1, 1e-7);
  EXPECT_NEAR(read.set.force_left[5], 0.1, 1e-12);
  EXPECT_THAT(codes_of(read.findings), Contains("joined-by-time@0"));
}

}  // namespace
}  // namespace awmr::testing::dataflash_test
