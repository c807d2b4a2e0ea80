/// Times that a file gives rounded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "trial_text.h"

namespace awmr::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kRows = 400;

/// A log of kRows rows with these times, rounded to multiples of `resolution_s`.
Read<DrivingLog> log_at(const std::function<double(int)>& time_s, double resolution_s) {
  std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps\n";
  for (int i = 0; i < kRows; ++i) {
    text +=
        fmt::format("{:.6f},0.2,0.2,0,{}\n", resolution_s * std::round(time_s(i) / resolution_s),
                    1.0 + 0.3 * std::sin(0.1 * i));
  }
  return accepted(read_log, text);
}

/// Largest error of the time differences of a log, s.
double largest_error_s(const DrivingLog& log, const std::function<double(int)>& time_s) {
  double largest = 0.0;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double true_s = time_s(static_cast<int>(i)) - time_s(0);
    largest = std::max(largest, std::abs(log.t_s[i] - log.t_s[0] - true_s));
  }
  return largest;
}

TEST(RoundedTimes, OfEvenlySpacedRowsAreReplaced) {
  for (const double rate_hz : {30.0, 49.0, 60.0}) {
    const auto time_s = [&](int i) { return 0.004 + i / rate_hz; };
    const auto read = log_at(time_s, 0.01);
    ASSERT_THAT(codes_of(read.findings), Contains("rounded-times@2")) << rate_hz;
    EXPECT_EQ(read.findings.front().severity, Severity::kNote);
    // The slope of a line through n rows with errors up to q/2 is off by less than q/n per row.
    EXPECT_LT(largest_error_s(read.set, time_s), 0.2 * 0.01) << rate_hz;
  }
}

TEST(RoundedTimes, OfALogWithLostRowsAreKept) {
  const auto time_s = [](int i) { return 0.1 * (i + i / 9); };  // every tenth row is lost
  const auto read = log_at(time_s, 0.1);
  EXPECT_LT(largest_error_s(read.set, time_s), 1e-9);
}

TEST(RoundedTimes, AreReplacedIfRowsAreMissing) {
  const auto time_s = [](int i) { return (i + i / 37) / 30.0; };  // every 38th row is missing
  const auto read = log_at(time_s, 0.01);
  EXPECT_THAT(codes_of(read.findings), Contains("rounded-times@2"));
  EXPECT_LT(largest_error_s(read.set, time_s), 0.2 * 0.01);
}

TEST(RoundedTimes, OfUnevenRowsAreReportedAndKept) {
  std::mt19937 random(3);
  std::vector<double> times{0.0};
  std::uniform_real_distribution<double> step_s(0.02, 0.06);
  while (times.size() < kRows) times.push_back(times.back() + step_s(random));
  const auto time_s = [&](int i) { return times[static_cast<std::size_t>(i)]; };
  const auto read = log_at(time_s, 0.01);
  ASSERT_THAT(codes_of(read.findings), Contains("rounded-times@2"));
  EXPECT_EQ(read.findings.front().severity, Severity::kWarning);
  EXPECT_GT(largest_error_s(read.set, time_s), 0.4 * 0.01);
  // milliseconds are fine enough
  EXPECT_THAT(codes_of(log_at(time_s, 0.001).findings), Not(Contains(HasSubstr("rounded-times"))));
}

TEST(RoundedTimes, AreNotSeenInExactTimes) {
  const auto is_kept = [](const std::function<double(int)>& time_s, double resolution_s) {
    const auto read = log_at(time_s, resolution_s);
    EXPECT_THAT(codes_of(read.findings), Not(Contains(HasSubstr("rounded-times"))));
    EXPECT_LT(largest_error_s(read.set, time_s), 1e-6);
  };
  is_kept([](int i) { return 0.02 * i; }, 0.01);             // 50 Hz
  is_kept([](int i) { return 0.02 * (i + i / 90); }, 0.01);  // 50 Hz, every 91st row is missing
  is_kept([](int i) { return 0.02 * i + (i == 200) * 0.01; }, 0.01);  // one late row
}

TEST(RoundedTimes, OfACoastDownAreReplaced) {
  std::string text = "t_s,speed_mps\n";
  for (int i = 0; i < 60; ++i) text += fmt::format("{:.2f},{}\n", i / 30.0, 1.0 - i / 60.0);
  std::vector<Finding> findings;
  const ScratchFile file("coast.csv", text);
  const auto set = read_coastdown(file.path(), {}, findings);
  ASSERT_TRUE(set);
  EXPECT_THAT(codes_of(findings), ElementsAre("rounded-times@2"));
  const CoastCurve& curve = std::get<std::vector<CoastCurve>>(*set).front();
  EXPECT_NEAR(curve.t_s[50] - curve.t_s[10], 40.0 / 30.0, 1e-3);
}

}  // namespace
}  // namespace awmr::testing
