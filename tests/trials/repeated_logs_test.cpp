/// Recordings that are given twice, wholly or in part.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "awmr/core/random.h"
#include "awmr/trials/load.h"
#include "trial_text.h"

namespace awmr::testing::repeated_logs_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kRows = 400;

/// How a file shows a recording.
struct Shown {
  int begin = 0;
  int end = kRows;
  int every = 1;         ///< every such row
  double start_s = 0.0;  ///< time of the first row
  int decimals = 6;      ///< of the measurements
  bool has_yaw = true;   ///< false: without yaw rate
};

/// The drive `drive`: the same commands in every drive, and measurements with the noise of this one.
std::string text_of(std::uint64_t drive, const Shown& shown, double noise = 0.01) {
  Random random(drive, 3);
  std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps";
  text += shown.has_yaw ? ",yaw_rate_radps\n" : "\n";
  for (int i = 0; i < kRows; ++i) {
    const double speed = 1.0 - std::exp(-0.02 * i) + 0.2 * std::sin(0.05 * i);
    const double seen_mps = speed + noise * random.normal();
    const double seen_radps = 0.3 * std::sin(0.07 * i) + noise * random.normal();
    if (i < shown.begin || i >= shown.end || (i - shown.begin) % shown.every != 0) continue;
    text += fmt::format("{:.3f},{},{},5,{:.{}f}", shown.start_s + 0.05 * (i - shown.begin),
                        0.3 + 0.1 * (i / 40 % 3), 0.3, seen_mps, shown.decimals);
    if (shown.has_yaw) text += fmt::format(",{:.{}f}", seen_radps, shown.decimals);
    text += "\n";
  }
  return text;
}

/// Message of the error with which two logs are refused; empty if they are accepted.
std::string refusal(const std::string& one, const std::string& other) {
  const ScratchFile first("one.csv", one);
  const ScratchFile second("two.csv", other);
  TrialFiles files{.options = {.columns = {}, .as_is = true}};
  files.logs = {first.path(), second.path()};
  const auto trials = load_trials(paper_vehicle(), files);
  if (trials) return "";
  EXPECT_EQ(trials.error().faults.front().code, ErrorCode::kGivenTwice);
  return to_text(trials.error());
}

TEST(RepeatedLogs, AreRefusedHoweverTheCopyIsWritten) {
  const std::string drive = text_of(1, {});
  EXPECT_THAT(refusal(drive, drive), HasSubstr("lines 2 to 401 are the same recording as lines 2"));
  EXPECT_THAT(refusal(drive, text_of(1, {.start_s = 1000.0})), HasSubstr("same recording"));
  EXPECT_THAT(refusal(drive, text_of(1, {.decimals = 3})), HasSubstr("same recording"));
  EXPECT_THAT(refusal(drive, text_of(1, {.has_yaw = false})), HasSubstr("same recording"));
  EXPECT_THAT(refusal(drive, text_of(1, {.every = 2})), HasSubstr("same recording"));
}

/// The last rows at rest do not change, so that they do not tell whether the logs are the same.
TEST(RepeatedLogs, ThatEndAtRestAreRefused) {
  std::string drive = text_of(1, {.end = 300});
  for (int i = 300; i < kRows; ++i) drive += fmt::format("{:.3f},0,0,0,0,0\n", 0.05 * i);
  EXPECT_THAT(refusal(drive, drive), HasSubstr("lines 2 to 401 are the same recording"));
  std::string coarser = text_of(1, {.end = 300, .decimals = 3});
  for (int i = 300; i < kRows; ++i) coarser += fmt::format("{:.3f},0,0,0,0,0\n", 0.05 * i);
  EXPECT_THAT(refusal(drive, coarser), HasSubstr("lines 2 to 401 are the same recording"));
}

TEST(RepeatedLogs, WithAPartInCommonAreRefusedWithItsLines) {
  const std::string drive = text_of(1, {});
  // contained in the middle: row 100 is line 102
  EXPECT_THAT(refusal(drive, text_of(1, {.begin = 100, .end = 250})),
              HasSubstr("lines 2 to 151 are the same recording as lines 102 to 251"));
  EXPECT_THAT(refusal(drive, text_of(1, {.end = 150})), HasSubstr("same recording"));
  EXPECT_THAT(refusal(text_of(1, {.end = 250}), text_of(1, {.begin = 150})),
              HasSubstr("same recording"));
}

TEST(RepeatedLogs, SeparateDrivesWithTheSameCommandsAreAccepted) {
  EXPECT_THAT(refusal(text_of(1, {}), text_of(2, {})), IsEmpty());
  // a coarse speed alone
  const Shown coarse{.decimals = 2, .has_yaw = false};
  EXPECT_THAT(refusal(text_of(1, coarse), text_of(2, coarse)), IsEmpty());
  EXPECT_THAT(refusal(text_of(1, coarse, 0.003), text_of(2, coarse, 0.003)), IsEmpty());
}

TEST(RepeatedLogs, NoiseFreeDrivesThatBeginAlikeAreAccepted) {
  std::string other = text_of(1, {.end = 200}, 0.0);
  for (int i = 200; i < kRows; ++i) {
    other += fmt::format("{:.3f},0.1,0.1,0,{:.6f},{:.6f}\n", 0.05 * i, 1.0 / (i - 150), 1e-3 * i);
  }
  EXPECT_THAT(refusal(text_of(1, {}, 0.0), other), IsEmpty());
}

TEST(RepeatedLogs, ACoastDownThatIsGivenTwiceIsRefused) {
  const auto curve = [](double start_s, double first_mps) {
    std::string text = "t_s,speed_mps\n";
    for (int i = 0; i < 30; ++i) {
      text += fmt::format("{},{:.4f}\n", start_s + 0.1 * i, first_mps * std::exp(-0.1 * i));
    }
    return text;
  };
  const ScratchFile one("one.csv", curve(0.0, 1.0));
  const ScratchFile copy("copy.csv", curve(7.0, 1.0));
  const ScratchFile other("other.csv", curve(0.0, 1.2));
  TrialFiles files{.coastdowns = {one.path(), other.path()}};
  EXPECT_TRUE(load_trials(paper_vehicle(), files));
  files.coastdowns = {one.path(), copy.path()};
  const auto trials = load_trials(paper_vehicle(), files);
  ASSERT_FALSE(trials);
  EXPECT_EQ(trials.error().faults.front().code, ErrorCode::kGivenTwice);
}

}  // namespace
}  // namespace awmr::testing::repeated_logs_test
