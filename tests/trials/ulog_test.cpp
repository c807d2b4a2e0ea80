/// PX4 ULog: signals read, and all kinds of invalid files.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "awmr/trials/formats/log_formats.h"
#include "awmr/trials/read_trials.h"
#include "binary_text.h"
#include "trial_text.h"

namespace awmr::testing::ulog_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Wanted kAll = [](const std::string&) { return true; };

Result<Signals> read(const std::string& bytes, const Wanted& wanted = kAll) {
  return read_ulog(bytes, "a.ulg", wanted);
}

std::string refusal_of(const std::string& bytes) {
  const auto signals = read(bytes);
  return signals ? "" : to_text(signals.error());
}

std::string small_log() {
  return ulog_header() +
         ulog_format("out:uint64_t timestamp;float[2] u;uint8_t mode;uint8_t[3] _padding0;") +
         ulog_format("vec:float x;float y;") +
         ulog_format("odom:uint64_t timestamp;vec v;int16_t n;char[4] id;bool ok;") +
         ulog_topic(0, 3, "out") + ulog_topic(0, 4, "odom") + ulog_topic(1, 5, "odom") +
         ulog_data(3, 1000, le(0.5F) + le(0.25F) + "\x02") +
         ulog_data(4, 1500, le(1.5F) + le(-2.0F) + le(std::int16_t{-7}) + "abcd\x01") +
         ulog_data(5, 1600, le(9.0F) + le(9.0F) + le(std::int16_t{9}) + "abcd\x01") +
         ulog_data(3, 2000, le(0.75F) + le(0.5F) + "\x02") + ulog_message('L', "hello") +
         ulog_message('?', "of a later version");
}

TEST(Ulog, FlattensTopicsInstancesArraysAndNestedTypes) {
  const auto signals = read(small_log());
  ASSERT_TRUE(signals) << to_text(signals.error());
  EXPECT_THAT(signals->header,
              ElementsAre("out.timestamp", "out.u[0]", "out.u[1]", "out.mode", "odom.timestamp",
                          "odom.v.x", "odom.v.y", "odom.n", "odom.ok", "odom[1].timestamp",
                          "odom[1].v.x", "odom[1].v.y", "odom[1].n", "odom[1].ok"));
  ASSERT_THAT(signals->topics, SizeIs(3));
  EXPECT_THAT(signals->topics[0].time_ns, ElementsAre(1'000'000, 2'000'000));
  EXPECT_THAT(signals->topics[0].values[1], ElementsAre(0.5, 0.75));
  EXPECT_THAT(signals->topics[1].values[3], ElementsAre(-7.0));
  EXPECT_THAT(signals->topics[2].values[1], ElementsAre(9.0));
  EXPECT_THAT(signals->notes, IsEmpty());
}

TEST(Ulog, KeepsOnlyRequestedSignals) {
  const auto signals =
      read(small_log(), [](const std::string& name) { return name == "odom.v.y"; });
  ASSERT_TRUE(signals);
  EXPECT_THAT(signals->header, SizeIs(14));
  EXPECT_THAT(signals->topics[0].time_ns, IsEmpty());
  EXPECT_THAT(signals->topics[1].values, ElementsAre(ElementsAre(-2.0)));
}

TEST(Ulog, AFileThatBreaksOffIsReadUpToThereAndNoted) {
  const std::string whole = small_log();
  for (std::size_t size = 16; size < whole.size(); ++size) {
    const auto signals = read(whole.substr(0, size));
    ASSERT_TRUE(signals) << size << to_text(signals.error());
    EXPECT_LE(signals->notes.size(), 1U);
  }
  EXPECT_EQ(read(whole.substr(0, whole.size() - 1))->notes[0].code, "log-truncated");
}

TEST(Ulog, WhatWasAppendedAfterACrashIsRead) {
  const std::string definitions =
      ulog_format("v:uint64_t timestamp;double x;") + ulog_topic(0, 1, "v");
  const std::string cut = ulog_data(1, 5, le(1.0)) + ulog_data(1, 6, le(2.0)).substr(0, 7);
  const std::size_t flag_bytes = 3 + 40;
  const std::uint64_t appended = 16 + flag_bytes + definitions.size() + cut.size();
  const std::string flags = ulog_message('B', std::string(8, '\0') + "\x01" + std::string(7, '\0') +
                                                  le(appended) + std::string(16, '\0'));
  const auto signals = read(ulog_header() + flags + definitions + cut + ulog_data(1, 7, le(3.0)));
  ASSERT_TRUE(signals) << to_text(signals.error());
  EXPECT_THAT(signals->topics[0].values[1], ElementsAre(1.0, 3.0));
  EXPECT_THAT(signals->notes, SizeIs(1));
}

TEST(Ulog, RefusesMalformedContent) {
  const std::string h = ulog_header();
  const std::string v = ulog_format("v:uint64_t timestamp;double x;");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {h + ulog_format("not a format"), "is not a format"},
      {h + ulog_format("v:"), "has no fields"},
      {h + ulog_format("v:uint64_t;"), "is not a field"},
      {h + ulog_format("v:float[0] x;"), "is not a field"},
      {h + ulog_format("v:float[99999999999999999999] x;"), "is not a field"},
      {h + ulog_format("v:float[2 x;"), "is not a field"},
      {h + ulog_topic(0, 1, "v"), "an unknown type"},
      {h + ulog_format("v:w x;") + ulog_topic(0, 1, "v"), "an unknown type"},
      {h + ulog_format("v:v x;") + ulog_topic(0, 1, "v"), "nested too deep"},
      {h + ulog_format("v:w[60000] x;") + ulog_format("w:u[60000] x;") +
           ulog_format("u:double x;") + ulog_topic(0, 1, "v"),
       "longer than any message"},
      {h + v + ulog_message('A', "\1"), "too short"},
      {h + v + ulog_topic(0, 1, ""), "too short"},
      {h + v + ulog_topic(0, 1, "v") + ulog_topic(1, 1, "v"), "a second topic has the id 1"},
      {h + ulog_data(1, 0, ""), "not announced"},
      {h + ulog_message('D', ""), "not announced"},
      {h + v + ulog_topic(0, 1, "v") + ulog_data(1, 0, "1234567"),
       "has 15 bytes; its format has 16"},
      {h + v + ulog_topic(0, 1, "v") + ulog_data(1, ~std::uint64_t{0}, le(1.0)), "too large"},
      {h + ulog_message('B', "short"), "flags are too short"},
      {h + ulog_message('B', std::string(8, '\0') + "\x02" + std::string(31, '\0')),
       "unsupported feature of ULog"}};
  for (const auto& [bytes, words] : cases)
    EXPECT_THAT(refusal_of(bytes), HasSubstr(words)) << words;
}

TEST(Ulog, ManySignalsAreRefusedBeforeTheyFillTheMemory) {
  std::string bytes = ulog_header() + ulog_format("v:uint64_t timestamp;uint8_t[60000] x;");
  for (std::uint16_t id = 0; id < 1000; ++id)
    bytes += ulog_topic(static_cast<std::uint8_t>(id), id, "v");
  EXPECT_THAT(refusal_of(bytes), HasSubstr("more than 200000 signals"));
}

/// A drive: commands every 40 ms, odometry every 20 ms.
std::string drive(double bad = 1.0) {
  std::string bytes = ulog_header() +
                      ulog_format("motors:uint64_t timestamp;float[2] control;float steering;") +
                      ulog_format("odometry:uint64_t timestamp;float v;float r;") +
                      ulog_topic(0, 1, "motors") + ulog_topic(0, 2, "odometry");
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto x = static_cast<float>(i);
    if (i % 2 == 0) bytes += ulog_data(1, 20'000 * i, le(0.1F) + le(0.2F) + le(0.05F));
    bytes += ulog_data(
        2, 20'000 * i + 700,
        le(1.0F + 0.01F * x * static_cast<float>(i == 30 ? bad : 1.0)) + le(0.3F + 0.001F * x * x));
  }
  return bytes;
}

const TrialOptions kDrive{.columns = {*parse_column("force_left=motors.control[0]"),
                                      *parse_column("force_right=motors.control[1]"),
                                      *parse_column("steering_cmd_deg=motors.steering*180/pi"),
                                      *parse_column("speed_mps=odometry.v"),
                                      *parse_column("yaw_rate_radps=odometry.r*1")}};

TEST(Ulog, IsReadAsALog) {
  const auto read = accepted(read_log, drive(), kDrive);
  EXPECT_EQ(read.set.rows(), 75U);
  EXPECT_EQ(read.set[LogChannel::kSpeed]->fresh_count, 50);
  EXPECT_FLOAT_EQ(static_cast<float>(read.set.force_right[40]), 0.2F);
  EXPECT_NEAR(read.set.t_s[1], 7e-4, 1e-12);
  EXPECT_THAT(codes_of(read.findings), Contains("joined-by-time@0"));
}

TEST(Ulog, NaNIsNoValueAndNotedAndInfinityAFault) {
  const auto read = accepted(read_log, drive(std::nan("")), kDrive);
  EXPECT_EQ(read.set[LogChannel::kSpeed]->fresh_count, 49);
  EXPECT_EQ(read.set[LogChannel::kYawRate]->fresh_count, 50);
  EXPECT_THAT(codes_of(read.findings), Contains("missing-values@0"));
  const ScratchFile file("a.ulg", drive(std::numeric_limits<double>::infinity()));
  std::vector<Finding> findings;
  const auto log = read_log(file.path(), kDrive, findings);
  ASSERT_FALSE(log);
  EXPECT_THAT(to_text(log.error()), HasSubstr("message 31 of odometry: odometry.v is infinite"));
}

TEST(Ulog, TimeThatGoesBackAndSignalsThatAreNotThereAreRefused) {
  std::vector<Finding> findings;
  const ScratchFile back("a.ulg", drive() + ulog_data(2, 5, le(1.0F) + le(1.0F)));
  EXPECT_THAT(to_text(read_log(back.path(), kDrive, findings).error()),
              HasSubstr("time must increase within a topic"));
  const ScratchFile file("a.ulg", drive());
  TrialOptions wrong = kDrive;
  wrong.columns[3] = *parse_column("speed_mps=odometry.vv*1");
  wrong.columns[0] = *parse_column("force_left=motors.contro[0]");
  EXPECT_THAT(to_text(read_log(file.path(), wrong, findings).error()),
              AllOf(HasSubstr("did you mean \"motors.control[0]\"?")));
}

}  // namespace
}  // namespace awmr::testing::ulog_test
