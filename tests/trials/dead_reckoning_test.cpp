// Pose columns that only integrate speed and yaw rate (awmr/trials/checks/dead_reckoning.h).
#include "awmr/trials/checks/dead_reckoning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "awmr/core/random.h"

namespace awmr {
namespace {

/// A drive at about 0.5 m/s in curves, in `rows` steps of 0.05 s.
struct Drive {
  explicit Drive(std::uint64_t seed) : random(seed, 1) {}
  double speed(double row) const { return 0.5 + 0.3 * std::sin(0.07 * row); }
  double yaw_rate(double row) const { return 0.8 * std::sin(0.031 * row); }
  /// `true_value` as a sensor with `noise` measures it.
  double measured(double true_value, double noise) { return true_value + noise * random.normal(); }
  Random random;
};

constexpr int kRows = 1200;
constexpr double kStep_s = 0.05;

Measured channel(const std::function<double(int)>& value) {
  Measured found;
  for (int row = 0; row < kRows; ++row) found.value.push_back(value(row));
  found.fresh.assign(kRows, true);
  return found;
}

/// Speed and yaw rate with noise, without a pose.
DrivingLog log_of_rates(Drive& drive, double noise) {
  DrivingLog log;
  for (int row = 0; row < kRows; ++row) log.t_s.push_back(kStep_s * row);
  log[LogChannel::kSpeed] =
      channel([&](int row) { return drive.measured(drive.speed(row), noise); });
  log[LogChannel::kYawRate] =
      channel([&](int row) { return drive.measured(drive.yaw_rate(row), noise); });
  return log;
}

struct Pose {
  double x = 3.0;
  double y = -1.0;
  double heading = 0.4;
  void move(double way, double turn) {
    x += way * std::cos(heading + 0.5 * turn);
    y += way * std::sin(heading + 0.5 * turn);
    heading += turn;
  }
};

/// Adds the poses that `move` leads to from row to row.
void add_poses(const std::function<void(std::size_t row, Pose&)>& move, DrivingLog& log) {
  for (const LogChannel c : {LogChannel::kX, LogChannel::kY, LogChannel::kHeading})
    log[c].emplace();
  Pose pose;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (row > 0) move(row, pose);
    log[LogChannel::kX]->value.push_back(pose.x);
    log[LogChannel::kY]->value.push_back(pose.y);
    log[LogChannel::kHeading]->value.push_back(pose.heading);
  }
}

/// Adds the pose that an odometry computes from the speed and yaw rate of the log.
void add_odometry(DrivingLog& log) {
  const DrivingLog& rates = log;
  const auto move = [&](std::size_t row, Pose& pose) {
    const double step_s = log.t_s[row] - log.t_s[row - 1];
    pose.move(rates[LogChannel::kSpeed]->value[row] * step_s,
              rates[LogChannel::kYawRate]->value[row] * step_s);
  };
  add_poses(move, log);
}

/// Adds the true pose, as measured by sensors without noise.
void add_true_pose(const Drive& drive, DrivingLog& log) {
  constexpr int kParts = 20;
  const auto move = [&](std::size_t row, Pose& pose) {
    for (int part = 0; part < kParts; ++part) {
      const double at = static_cast<double>(row) - 1.0 + (part + 0.5) / kParts;
      pose.move(drive.speed(at) * kStep_s / kParts, drive.yaw_rate(at) * kStep_s / kParts);
    }
  };
  add_poses(move, log);
}

/// Number of findings of set_aside_dead_reckoning(), all of them `dead-reckoning`.
std::size_t found_in(DrivingLog& log) {
  std::vector<Finding> findings;
  set_aside_dead_reckoning(log, findings);
  for (const Finding& finding : findings) EXPECT_EQ(finding.code, "dead-reckoning");
  return findings.size();
}

TEST(DeadReckoning, PoseOfAnOdometryIsNotUsed) {
  Drive drive(1);
  DrivingLog log = log_of_rates(drive, 0.01);
  add_odometry(log);
  EXPECT_EQ(found_in(log), 2U);
  EXPECT_FALSE(log[LogChannel::kX] || log[LogChannel::kY] || log[LogChannel::kHeading]);
  EXPECT_TRUE(log[LogChannel::kSpeed] && log[LogChannel::kYawRate]);
}

TEST(DeadReckoning, PoseOfAnOdometrySlowerThanTheLogIsNotUsed) {
  Drive drive(2);
  DrivingLog log = log_of_rates(drive, 0.01);
  for (const LogChannel rate : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    for (int row = 0; row < kRows; ++row) {
      const auto at = static_cast<std::size_t>(row);
      if (row % 3 != 0) log[rate]->value[at] = log[rate]->value[at - 1];
    }
  }
  DrivingLog thinned;
  for (std::size_t row = 0; row < log.rows(); row += 3) thinned.t_s.push_back(log.t_s[row]);
  for (const LogChannel rate : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    thinned[rate].emplace();
    for (std::size_t row = 0; row < log.rows(); row += 3) {
      thinned[rate]->value.push_back(log[rate]->value[row]);
    }
  }
  add_odometry(thinned);
  for (const LogChannel pose : {LogChannel::kX, LogChannel::kY, LogChannel::kHeading}) {
    log[pose] =
        channel([&](int row) { return thinned[pose]->value[static_cast<std::size_t>(row / 3)]; });
  }
  EXPECT_EQ(found_in(log), 2U);
}

TEST(DeadReckoning, PoseOfSensorsOfItsOwnIsUsed) {
  for (const std::uint64_t seed : {3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U}) {
    for (const double noise : {0.0, 0.002, 0.05}) {
      Drive drive(seed);
      DrivingLog log = log_of_rates(drive, noise);
      add_true_pose(drive, log);
      EXPECT_EQ(found_in(log), 0U) << seed << " " << noise;
    }
  }
}

TEST(DeadReckoning, IntegratedGyroscopeBesidePositionsIsNotUsed) {
  Drive drive(11);
  DrivingLog log = log_of_rates(drive, 0.01);
  add_odometry(log);
  const Measured heading = *log[LogChannel::kHeading];
  add_true_pose(drive, log);
  log[LogChannel::kHeading] = heading;
  EXPECT_EQ(found_in(log), 1U);
  EXPECT_TRUE(log[LogChannel::kX] && log[LogChannel::kY]);
  EXPECT_FALSE(log[LogChannel::kHeading]);
}

}  // namespace
}  // namespace awmr
