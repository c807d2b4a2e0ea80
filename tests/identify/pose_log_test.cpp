// Logs of precise positions and headings without speeds, as those of motion capture.
#include <gtest/gtest.h>

#include "awmr/identify/logs/choice/family_fit.h"
#include "awmr/identify/logs/log_setup.h"
#include "awmr/identify/logs/problem/initial_guess.h"
#include "identify/synthetic_log.h"

namespace awmr::testing {
namespace {

constexpr SensorNoise kMotionCapture{.heading_rad = 0.0003, .position_m = 0.0001};

/// A fast 1:10 car with dry friction in surge and yaw.
Plant<double> fast_car() {
  Plant<double> car = paper_plant();
  car.surge = {.alpha = 0.12, .beta = 1.0, .coulomb = 0.07};
  car.yaw = {.alpha = 0.02, .beta = 1.0, .coulomb = 0.004};
  car.mass_norm = 0.22;
  car.inertia_norm = 0.004;
  car.half_track_m = 0.08;
  car.front_axle_m = 0.13;
  return car;
}

Vehicle its_file() {
  Vehicle vehicle = robot();
  vehicle.mass_kg = 2.4;
  vehicle.length_m = 0.42;
  vehicle.width_m = 0.2;
  vehicle.half_track_m = 0.08;
  vehicle.front_axle_m = 0.13;
  return vehicle;
}

std::vector<DrivingLog> poses_of_the_car() {
  Random random(3, 5);
  DrivingLog log = simulate_log(fast_car(), its_file(),
                                {.duration_s = 20.0, .rate_hz = 120.0, .hold_s = 0.8, .drive = 3},
                                kMotionCapture, random);
  log[LogChannel::kSpeed].reset();
  log[LogChannel::kYawRate].reset();
  return {log};
}

TEST(PoseGuess, IsNearTheTruth) {
  const std::vector<DrivingLog> logs = poses_of_the_car();
  const auto surge = surge_of_positions(logs, its_file());
  ASSERT_TRUE(surge);
  EXPECT_NEAR(surge->inertia / 0.22, 1.0, 0.1);
  const auto yaw = yaw_of_headings(logs, its_file());
  ASSERT_TRUE(yaw);
  EXPECT_NEAR(yaw->inertia / 0.004, 1.0, 0.5);
}

TEST(PoseGuess, IsForLogsWithoutTheSpeedAndForcesThatShowIt) {
  DrivingLog log = poses_of_the_car().front();
  DrivingLog constant = log;
  constant.force_left.assign(log.rows(), 0.0);
  constant.force_right.assign(log.rows(), 0.0);
  EXPECT_FALSE(surge_of_positions({constant}, its_file()));
  EXPECT_FALSE(yaw_of_headings({constant}, its_file()));
  EXPECT_FALSE(surge_of_positions({drive(kTruths[0], 1)}, robot()));
  EXPECT_FALSE(yaw_of_headings({drive(kTruths[0], 1)}, robot()));
  log[LogChannel::kHeading].reset();
  EXPECT_FALSE(surge_of_positions({log}, its_file()));
}

TEST(PoseLog, IsFittedInShortWindowsToTheTruth) {
  const std::vector<DrivingLog> logs = poses_of_the_car();
  std::map<ParameterId, std::string> reasons;
  LogFitOptions options = log_setup(its_file(), logs, {}, {}, Model{}, reasons);
  EXPECT_LT(options.window_s, 1.0);
  options.finds_delays = false;
  const FamilyFit found = fit_family(logs, options, Family::kCoulombLinear, Family::kCoulombLinear);
  ASSERT_TRUE(found.fit.usable);
  const ParameterValues<double> values = fitted_values(found.options, found.fit);
  EXPECT_NEAR(values[at(ParameterId::kMassNorm)] / 0.22, 1.0, 0.002);
  EXPECT_NEAR(values[at(ParameterId::kInertiaNorm)] / 0.004, 1.0, 0.01);
}

TEST(PoseLog, WithUsualNoiseIsFittedInLongWindows) {
  const std::vector<DrivingLog> logs{drive(kTruths[0], 1)};
  std::map<ParameterId, std::string> reasons;
  EXPECT_EQ(log_setup(robot(), logs, {}, {}, Model{}, reasons).window_s, kWindow_s);
}

}  // namespace
}  // namespace awmr::testing
