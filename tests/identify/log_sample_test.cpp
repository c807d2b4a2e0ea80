/// Fits of long logs, whose search begins with a sample of the windows.
#include "awmr/identify/logs/problem/log_problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "awmr/core/units.h"
#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;

TEST(LogSample, IsEvenlySpaced) {
  EXPECT_THAT(spread(3, 12), ElementsAre(0U, 1U, 2U));
  EXPECT_THAT(spread(60, 4), ElementsAre(0U, 15U, 30U, 45U));
}

TEST(LogSample, HasTheChannelsAndInitialStatesOfItsWindows) {
  DrivingLog without_position = drive(kTruths[1], 3, {.duration_s = 25.0});
  for (const LogChannel channel : {LogChannel::kX, LogChannel::kY}) {
    without_position[channel].reset();
  }
  const std::vector<DrivingLog> logs{drive(kTruths[1], 2, {.duration_s = 25.0}),
                                     std::move(without_position)};
  LogFitOptions options;
  options.vehicle = robot();
  options.free = {ParameterId::kMassNorm};
  const LogProblem problem = log_problem(logs, options);
  const SearchPoint point = from_measured(problem, problem.initial);
  const std::size_t last = problem.windows.size() - 1;
  ASSERT_EQ(problem.windows[last].rows.log, &logs[1]);
  EXPECT_FALSE(is_long(problem));
  const LogProblem part = with_windows(problem, {last});
  ASSERT_EQ(part.windows.size(), 1U);
  EXPECT_EQ(part.windows.front().rows.begin, problem.windows[last].rows.begin);
  EXPECT_TRUE(has_channel(problem.model.noise, LogChannel::kX));
  EXPECT_FALSE(has_channel(part.model.noise, LogChannel::kX));
  EXPECT_TRUE(has_channel(part.model.noise, LogChannel::kSpeed));
  const std::size_t components = problem.model.initial.size();
  const SearchPoint states = with_windows(problem, point, {last});
  ASSERT_EQ(states.initial_states.size(), components);
  EXPECT_TRUE(std::equal(states.initial_states.begin(), states.initial_states.end(),
                         point.initial_states.end() - static_cast<std::ptrdiff_t>(components)));
  EXPECT_EQ(states.coordinates, point.coordinates);
}

TEST(LogSample, LeadsToTheValuesOfLogsWithASlowServo) {
  constexpr double kRate_radps = 1.0;
  const Truth& t = kTruths[1];
  ASSERT_GT(radians(robot().steering_max_rate_degps), 4.0 * kRate_radps);
  Plant<double> slow = plant(t);
  slow.steering_max_rate_radps = kRate_radps;
  Random random(8, 5);
  TrialData data;
  // Each log has at least one window.
  for (std::uint64_t seed = 1; seed <= 2 * kSampleWindows; ++seed) {
    data.logs.push_back(simulate_log(slow, robot(),
                                     {.duration_s = 3.0, .rate_hz = 50.0, .drive = seed},
                                     kPreciseSensors, random));
    data.logs.back().file = std::to_string(seed);
  }
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "servo-rate"));
  const auto rate = estimated(*result, "steering.max_rate_radps");
  ASSERT_TRUE(rate && rate->std_error);
  EXPECT_NEAR(rate->value, kRate_radps, 4.5 * *rate->std_error);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

}  // namespace
}  // namespace awmr::testing
