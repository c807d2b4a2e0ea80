/// Logs with latency of steering, motors or sensors, with a steering trim, or with unequal motors.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/logs/log_fit.h"
#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/identify/logs/problem/residuals.h"
#include "awmr/identify/logs/problem/windows.h"
#include "awmr/model/model_file.h"
#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

constexpr double kStep_s = 0.02;  // row spacing of precise_drive()

DrivingLog precise_drive(const Truth& t) {
  return drive(t, 8, {.duration_s = 6.0, .rate_hz = 1.0 / kStep_s}, kMostPreciseSensors);
}

class LateLogs : public FitOfInstance {};
INSTANTIATE_TEST_SUITE_P(Short, LateLogs, ::testing::Values(false));
INSTANTIATE_TEST_SUITE_P(Long, LateLogs, ::testing::Values(true));

/// precise_drive() of twice the duration, with more noise.
DrivingLog long_drive(const Truth& t) {
  return drive(t, 8, {.duration_s = 12.0, .rate_hz = 1.0 / kStep_s}, kVeryPreciseSensors);
}

/// Returns the log with the steering command moved to `rows` rows earlier: the steering acts late.
DrivingLog with_late_steering(DrivingLog log, std::size_t rows) {
  std::vector<double>& command = *log.steering_command_rad;
  std::rotate(command.begin(), command.begin() + static_cast<std::ptrdiff_t>(rows), command.end());
  std::fill(command.end() - static_cast<std::ptrdiff_t>(rows), command.end(), 0.0);
  return log;
}

TEST(LateLog, SeparatesASteeringDeadTimeFromServoLag) {
  constexpr std::size_t kRows = 4;
  TrialData data;
  data.logs = {with_late_steering(long_drive(kTruths[1]), kRows)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "steering.delay_s", kStep_s * kRows);
  EXPECT_TRUE(has_finding(*result, "steering-delay"));
  expect_recovered(*result, ParameterId::kSteeringTimeConstant,
                   plant(kTruths[1]).steering_time_constant_s, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
}

/// Returns the log with the steering command moved to `rows` rows later: its time stamps are late.
DrivingLog with_late_steering_stamps(DrivingLog log, std::size_t rows) {
  std::vector<double>& command = *log.steering_command_rad;
  std::rotate(command.rbegin(), command.rbegin() + static_cast<std::ptrdiff_t>(rows),
              command.rend());
  std::fill(command.begin(), command.begin() + static_cast<std::ptrdiff_t>(rows), 0.0);
  return log;
}

TEST_P(LateLogs, FindsLateStampsOfTheSteeringAlone) {
  constexpr std::size_t kRows = 7;
  TrialData data;
  data.logs = {with_late_steering_stamps(precise_drive(kTruths[1]), kRows)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "steering.delay_s", -kStep_s * kRows);
  EXPECT_TRUE(has_finding(*result, "steering-delay"));
  EXPECT_FALSE(has_finding(*result, "actuator-lag", ""));
  expect_recovered(*result, ParameterId::kSteeringTimeConstant,
                   plant(kTruths[1]).steering_time_constant_s, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
}

/// Returns every `every`-th row of the log, with the motion of a vehicle on which the commands act
/// `rows_later` rows (of the original log) after the row in which they are logged.
DrivingLog with_late_commands(DrivingLog log, const Truth& t, std::size_t every,
                              std::size_t rows_later) {
  const DrivingLog all = log;
  DrivingLog logged = log;
  const auto row_of = [&](std::size_t i) { return i - i % every; };
  for (std::size_t i = 0; i < all.rows(); ++i) {
    const std::size_t from = row_of(i < rows_later ? 0 : i - rows_later);
    log.force_left[i] = all.force_left[from];
    log.force_right[i] = all.force_right[from];
    (*log.steering_command_rad)[i] = (*all.steering_command_rad)[from];
  }
  const auto true_motion = [&t](const DrivingLog& of) {
    std::vector<State<double>> states;
    replay<double>(LogSignals(of), 0, of.rows(), plant(t), nullptr, 0.002, {},
                   [&](std::size_t, const State<double>& state) { states.push_back(state); });
    return states;
  };
  const std::vector<State<double>> before = true_motion(all);
  const std::vector<State<double>> late = true_motion(log);
  const auto thin = [every](auto& of) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < of.size(); i += every) of[count++] = of[i];
    of.resize(count);
  };
  for (const LogChannel channel : kChannels) {
    if (!logged[channel]) continue;
    for (std::size_t i = 0; i < all.rows(); ++i) {
      logged[channel]->value[i] += channel_of(late[i], channel) - channel_of(before[i], channel);
    }
    thin(logged[channel]->value);
    thin(logged[channel]->fresh);
    logged[channel]->fresh_count =
        static_cast<int>(std::ranges::count(logged[channel]->fresh, true));
  }
  thin(logged.line);
  thin(logged.t_s);
  thin(logged.force_left);
  thin(logged.force_right);
  thin(*logged.steering_command_rad);
  return logged;
}

TEST(LateLog, FindsACommandDelayOfAFractionOfARow) {
  // The commands are late by 2.25 rows of 0.04 s, and the servo is at its rate limit after many
  // changes of the command.
  TrialData data;
  data.logs = {with_late_commands(drive(kTruths[1], 8, {.duration_s = 10.0}, kVeryPreciseSensors),
                                  kTruths[1], 4, 9)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "input_delay_s", 0.09);
  EXPECT_FALSE(has_finding(*result, "sensor-delay"));
  EXPECT_FALSE(has_finding(*result, "sensor-lag"));
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSteeringTimeConstant,
                   plant(kTruths[1]).steering_time_constant_s, 4.5);
}

TEST(LateLog, KeepsAMotorLagOfTheVehicleFileFixed) {
  constexpr double kLag_s = 0.08;
  TrialData data;
  data.logs = {drive_with_lag(kTruths[1], 8, kLag_s, {.duration_s = 6.0, .rate_hz = 50.0})};
  Vehicle vehicle = robot();
  vehicle.motor_time_constant_s = kLag_s;
  const auto result = identify(vehicle, data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(estimated(*result, "motor.time_constant_s"));
  EXPECT_FALSE(has_finding(*result, "actuator-lag"));
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, kTruths[1].a1, 4.5);
}

/// The drive of a vehicle with nearly linear resistance and a motor lag of kLag_s. The yaw motion
/// has the time constant 0.21 s, so that the lag and I'z could be exchanged.
struct LaggingMotors : ::testing::Test {
  static constexpr double kLag_s = 0.1;
  static constexpr Truth kLinear{0.9, 0.95, 0.3, 0.95, 0.4};

  static DrivingLog drive_of(DrivePlan plan) { return drive_with_lag(kLinear, 8, kLag_s, plan); }
};

/// The readings of a channel, `rows` rows late; none in the first `rows` rows.
void delay_by(std::size_t rows, Measured& channel) {
  std::vector<double>& values = channel.value;
  std::copy_backward(values.begin(), values.end() - eigen_index(rows), values.end());
  std::fill_n(channel.fresh.begin(), rows, false);
  channel.fresh_count = static_cast<int>(std::ranges::count(channel.fresh, true));
}

TEST_F(LaggingMotors, AreFoundBesideALateSpeedAndPosition) {
  constexpr std::size_t kRows = 6;
  DrivingLog log = drive_of({.duration_s = 10.0, .rate_hz = 50.0});
  for (const LogChannel c : {LogChannel::kSpeed, LogChannel::kX, LogChannel::kY}) {
    delay_by(kRows, *log[c]);
  }
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "motor.time_constant_s", kLag_s);
  expect_estimated(*result, "delay.speed_mps", 0.02 * kRows);
  EXPECT_FALSE(has_finding(*result, "sensor-lag"));
  expect_recovered(*result, ParameterId::kMassNorm, kLinear.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kLinear.mass_norm, 4.5);
}

/// The log without its first `rows` rows.
DrivingLog without_first(std::size_t rows, DrivingLog log) {
  const auto erase = [&](auto& values) {
    values.erase(values.begin(), values.begin() + eigen_index(rows));
  };
  erase(log.t_s);
  erase(log.line);
  erase(log.force_left);
  erase(log.force_right);
  erase(*log.steering_command_rad);
  for (std::optional<Measured>& channel : log.measured) {
    if (!channel) continue;
    erase(channel->value);
    erase(channel->fresh);
    channel->fresh_count = static_cast<int>(std::ranges::count(channel->fresh, true));
  }
  return log;
}

/// On a straight drive with linear resistance, the lag of the motors and the motion have the same
/// effect.
TEST_F(LaggingMotors, LeaveTwoValuesOfTheMassOnAStraightDrive) {
  constexpr Truth kStraight{0.9, 1.0, 0.3, 1.0, 0.27};
  TrialData data;
  data.logs = {
      without_first(80, drive_with_lag(kStraight, 8, kLag_s,
                                       {.duration_s = 20.0, .rate_hz = 50.0, .straight = true}))};
  remove_pose(data.logs.front());
  data.logs.front()[LogChannel::kYawRate].reset();
  Vehicle free = robot();
  free.surge_beta_range = Vehicle{}.surge_beta_range;
  const auto open = identify(free, data, power_law(), {});
  ASSERT_TRUE(open);
  EXPECT_FALSE(open->model[ParameterId::kMassNorm].value);
  expect_recovered(*open, ParameterId::kSurgeAlpha, kStraight.a1, 4.5);
  Vehicle known = free;
  known.motor_time_constant_s = kLag_s;
  const auto result = identify(known, data, power_law(), {});
  ASSERT_TRUE(result);
  expect_recovered(*result, ParameterId::kMassNorm, kStraight.mass_norm, 4.5);
}

/// Filters a channel by a first-order lag: dy/dt = (u - y)/T, exactly for ramps between the rows,
/// or with one step for each row (`is_at_rows`).
DrivingLog with_smoothed(DrivingLog log, LogChannel channel, double lag_s, bool is_at_rows) {
  std::vector<double> all(log.rows());
  replay<double>(
      LogSignals(log), 0, log.rows(), plant(kTruths[1]), nullptr, 0.002, {},
      [&](std::size_t row, const State<double>& state) { all[row] = channel_of(state, channel); });
  std::vector<double>& shown = log[channel]->value;
  const double e = std::exp(-kStep_s / lag_s);
  double y = all.front();
  for (std::size_t i = 1; i < log.rows(); ++i) {
    const double slope = (all[i] - all[i - 1]) / kStep_s;
    y = is_at_rows ? e * y + (1.0 - e) * all[i]
                   : all[i] - slope * lag_s + (y - all[i - 1] + slope * lag_s) * e;
    shown[i] += y - all[i];
  }
  return log;
}

class SmoothedSpeed : public ::testing::TestWithParam<bool> {};

TEST_P(SmoothedSpeed, IsAllowedFor) {
  constexpr double kLag_s = 0.2;
  const Truth& t = kTruths[1];
  TrialData data;
  data.logs = {with_smoothed(precise_drive(t), LogChannel::kSpeed, kLag_s, GetParam())};
  const auto result = identify(robot(), data, options_of_instance(), {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "lag.speed_mps", kLag_s);
  EXPECT_TRUE(has_finding(*result, "sensor-lag"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
}
/// Test parameter: true for a recursive filter.
INSTANTIATE_TEST_SUITE_P(Short, SmoothedSpeed, ::testing::Bool());
INSTANTIATE_TEST_SUITE_P(Long, SmoothedSpeed, ::testing::Bool());

/// Filters the speed by T^2 d2y/dt2 + 2 zeta T dy/dt + y = u. Integrates in steps of a fiftieth of
/// a row. u is the speed, interpolated linearly between rows.
DrivingLog with_speed_of_second_order(DrivingLog log, double lag_s, double damping) {
  constexpr int kSteps = 50;
  std::vector<double> all(log.rows());
  replay<double>(LogSignals(log), 0, log.rows(), plant(kTruths[1]), nullptr, 0.002, {},
                 [&](std::size_t row, const State<double>& state) { all[row] = state.u_mps; });
  const double h = kStep_s / kSteps;
  double y = all.front();
  double rate = 0.0;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double u = all[i - 1] + (k + 0.5) / kSteps * (all[i] - all[i - 1]);
      rate += h * ((u - y) / lag_s - 2.0 * damping * rate) / lag_s;  // symplectic Euler
      y += h * rate;
    }
    log[LogChannel::kSpeed]->value[i] += y - all[i];
  }
  return log;
}

class SpeedOfSecondOrder : public ::testing::TestWithParam<double> {};

TEST_P(SpeedOfSecondOrder, IsAllowedFor) {
  constexpr double kLag_s = 0.12;
  const Truth& t = kTruths[1];
  TrialData data;
  data.logs = {with_speed_of_second_order(precise_drive(t), kLag_s, GetParam())};
  const auto result = identify(robot(), data, options_of_instance(), {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "lag.speed_mps", kLag_s);
  EXPECT_TRUE(has_finding(*result, "sensor-lag", "second order"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
}
/// Damping ratio: critical, and that of a Butterworth filter.
INSTANTIATE_TEST_SUITE_P(Short, SpeedOfSecondOrder, ::testing::Values(1.0, 0.70710678));
INSTANTIATE_TEST_SUITE_P(Long, SpeedOfSecondOrder, ::testing::Values(1.0, 0.70710678));

TEST_P(LateLogs, AllowsForASmoothedCompassWithoutAGyroscope) {
  constexpr double kLag_s = 0.2;
  const Truth& t = kTruths[1];
  DrivingLog log = with_smoothed(precise_drive(t), LogChannel::kHeading, kLag_s, false);
  for (const LogChannel absent : {LogChannel::kX, LogChannel::kY, LogChannel::kYawRate}) {
    log[absent].reset();
  }
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "lag.heading_rad", kLag_s);
  EXPECT_TRUE(has_finding(*result, "sensor-lag", "heading_rad"));
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

/// The log with a yaw rate that is computed as the difference of successive headings. Heading and
/// position are then removed from the log.
DrivingLog with_differenced_heading(DrivingLog log) {
  const std::vector<double>& heading = log[LogChannel::kHeading]->value;
  std::vector<double>& rate = log[LogChannel::kYawRate]->value;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    rate[i] = (heading[i] - heading[i - 1]) / kStep_s;
  }
  rate.front() = rate[1];
  remove_pose(log);
  return log;
}

TEST(LateLog, AllowsForAYawRateThatIsTheDifferenceOfHeadings) {
  const Truth& t = kTruths[1];
  TrialData data;
  data.logs = {with_differenced_heading(precise_drive(t))};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
  const Estimate& inertia = result->model[ParameterId::kInertiaNorm];
  // If the noise of the yaw rate were modelled as white noise of the same size, the standard error
  // would be a third of the value.
  EXPECT_LT(*inertia.std_error, 0.1 * *inertia.value);
}

/// The log with one channel averaged over the rows from `reach` before to `reach` after each row.
DrivingLog with_centred_mean(DrivingLog log, LogChannel channel, std::size_t reach) {
  const std::vector<double> raw = log[channel]->value;
  for (std::size_t i = reach; i + reach < raw.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = i - reach; k <= i + reach; ++k) sum += raw[k];
    log[channel]->value[i] = sum / static_cast<double>(2 * reach + 1);
  }
  return log;
}

TEST_P(LateLogs, AllowsForSpeedAndYawRateThatWereSmoothedAfterTheDrive) {
  constexpr std::size_t kReach = 4;
  const Truth& t = kTruths[1];
  TrialData data;
  data.logs = {long_drive(t)};
  for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    data.logs.front() = with_centred_mean(std::move(data.logs.front()), channel, kReach);
  }
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  // Variance of a uniform distribution over 2 k + 1 rows: k (k + 1)/3 in units of rows^2.
  const double variance_s2 = kReach * (kReach + 1) / 3.0 * kStep_s * kStep_s;
  for (const char* const name : {"smoothing_s2.speed_mps", "smoothing_s2.yaw_rate_radps"}) {
    const auto smoothing = estimated(*result, name);
    ASSERT_TRUE(smoothing && smoothing->std_error) << name;
    EXPECT_NEAR(smoothing->value, variance_s2, 0.1 * variance_s2) << name;
  }
  EXPECT_TRUE(has_finding(*result, "smoothed-channel"));
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

/// The log with a speed measured by a wheel that is `left_m` to the left of the centre line.
DrivingLog with_speed_of_wheel(DrivingLog log, const Truth& t, double left_m) {
  Random random(4, 9);
  replay<double>(LogSignals(log), 0, log.rows(), plant(t), nullptr, 0.002, {},
                 [&](std::size_t row, const State<double>& s) {
                   log[LogChannel::kSpeed]->value[row] =
                       s.u_mps - left_m * s.r_radps + 0.01 * random.normal();
                 });
  return log;
}

TEST(LateLog, FindsTheDeviationOfACompass) {
  constexpr double kSin_rad = 0.11;
  constexpr double kCos_rad = -0.06;
  constexpr double kSin2_rad = 0.05;
  constexpr double kCos2_rad = 0.03;
  const Truth& t = kTruths[1];
  DrivingLog log = precise_drive(t);
  for (double& psi_rad : log[LogChannel::kHeading]->value) {
    psi_rad += kSin_rad * std::sin(psi_rad) + kCos_rad * std::cos(psi_rad) +
               kSin2_rad * std::sin(2.0 * psi_rad) + kCos2_rad * std::cos(2.0 * psi_rad);
  }
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  for (const auto& [name, truth] :
       {std::pair("compass.sin_rad", kSin_rad), std::pair("compass.cos_rad", kCos_rad),
        std::pair("compass.sin2_rad", kSin2_rad), std::pair("compass.cos2_rad", kCos2_rad)}) {
    expect_estimated(*result, name, truth);
  }
  EXPECT_TRUE(has_finding(*result, "compass-deviation"));
  EXPECT_FALSE(has_finding(*result, "sensor-scale"));
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

TEST_P(LateLogs, FindsTheSpeedOfOneWheel) {
  const Truth& t = kTruths[1];
  const double half_track_m = robot().half_track_m;
  for (const double left_m : {half_track_m, -half_track_m}) {
    TrialData data;
    data.logs = {with_speed_of_wheel(precise_drive(t), t, left_m)};
    const auto result = identify(robot(), data, options(), {});
    ASSERT_TRUE(result);
    expect_estimated(*result, "speed.offset_m", left_m);
    EXPECT_TRUE(has_finding(*result, "speed-sensor", left_m > 0.0 ? "left" : "right"));
    EXPECT_FALSE(has_finding(*result, "force-imbalance"));
    expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
    expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
  }
}

TEST_P(LateLogs, FindsThePlaceOfAnAntenna) {
  constexpr double kAhead_m = 0.25;
  constexpr double kLeft_m = -0.12;
  const Truth& t = kTruths[1];
  DrivingLog log = precise_drive(t);
  replay<double>(LogSignals(log), 0, log.rows(), plant(t), nullptr, 0.002, {},
                 [&](std::size_t row, const State<double>& s) {
                   const double sine = std::sin(s.psi_rad);
                   const double cosine = std::cos(s.psi_rad);
                   log[LogChannel::kX]->value[row] += kAhead_m * cosine - kLeft_m * sine;
                   log[LogChannel::kY]->value[row] += kAhead_m * sine + kLeft_m * cosine;
                 });
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  for (const auto& [name, truth] :
       {std::pair("position.ahead_m", kAhead_m), std::pair("position.left_m", kLeft_m)}) {
    expect_estimated(*result, name, truth);
  }
  EXPECT_TRUE(has_finding(*result, "position-sensor"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

/// The log with the readings of a sway sensor that sits `ahead_m` ahead of the centre of gravity
/// and is turned to the left by `turned_rad`.
DrivingLog with_sway_sensor(DrivingLog log, double ahead_m, double turned_rad) {
  Random random(3, 9);
  Measured sway{.value = std::vector<double>(log.rows()),
                .fresh = std::vector<bool>(log.rows(), true),
                .fresh_count = static_cast<int>(log.rows())};
  replay<double>(LogSignals(log), 0, log.rows(), plant(kTruths[1]), nullptr, 0.002, {},
                 [&](std::size_t row, const State<double>& s) {
                   sway.value[row] = s.v_mps * std::cos(turned_rad) -
                                     s.u_mps * std::sin(turned_rad) + ahead_m * s.r_radps +
                                     0.01 * random.normal();
                 });
  log[LogChannel::kSway] = std::move(sway);
  return log;
}

TEST_P(LateLogs, FindsPlaceAndDirectionOfASwaySensor) {
  constexpr double kAhead_m = -0.04;
  constexpr double kTurned_rad = 0.03;
  const Truth& t = kTruths[1];
  TrialData data;
  data.logs = {with_sway_sensor(precise_drive(t), kAhead_m, kTurned_rad)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  const auto ahead = estimated(*result, "sway.offset_m");
  const auto turned = estimated(*result, "sway.angle_rad");
  ASSERT_TRUE(ahead && ahead->std_error && turned && turned->std_error);
  EXPECT_NEAR(ahead->value, kAhead_m, 4.5 * *ahead->std_error);
  EXPECT_NEAR(turned->value, kTurned_rad, 4.5 * *turned->std_error);
  EXPECT_TRUE(has_finding(*result, "sway-sensor", "behind the centre of gravity"));
  EXPECT_TRUE(has_finding(*result, "sway-sensor", "to the left"));
  expect_recovered(*result, ParameterId::kSwayAlpha, plant(t).sway_alpha, 4.5);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
}

/// The log with readings of slipping wheels: the speed, and the yaw rate if `of_yaw`.
DrivingLog with_slip(DrivingLog log, double slip, bool of_yaw) {
  const double half_track_m = robot().half_track_m;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double left = slip * log.force_left[i];
    const double right = slip * log.force_right[i];
    log[LogChannel::kSpeed]->value[i] += 0.5 * (left + right);
    if (of_yaw) log[LogChannel::kYawRate]->value[i] += 0.5 * (right - left) / half_track_m;
  }
  return log;
}

class SlippingWheels : public ::testing::TestWithParam<bool> {};

TEST_P(SlippingWheels, AreFoundInTheirReadings) {
  constexpr double kSlip_mps = 0.16;
  const Truth& t = kTruths[1];
  TrialData data;
  data.logs = {with_slip(precise_drive(t), kSlip_mps, GetParam())};
  const auto result = identify(robot(), data, options_of_instance(), {});
  ASSERT_TRUE(result);
  expect_estimated(*result, "slip.speed_mps", kSlip_mps);
  EXPECT_TRUE(has_finding(*result, "wheel-slip", "speed_mps"));
  EXPECT_EQ(has_finding(*result, "wheel-slip", "yaw_rate_radps"), GetParam());
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

TEST(LateLog, SlipWithoutAPositionWithdrawsWhatDependsOnIt) {
  for (const bool of_yaw : {false, true}) {
    DrivingLog log = with_slip(precise_drive(kTruths[1]), 0.16, of_yaw);
    for (const LogChannel absent : {LogChannel::kX, LogChannel::kY}) log[absent].reset();
    TrialData data;
    data.logs = {std::move(log)};
    const auto result = identify(robot(), data, power_law(), {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(has_finding(*result, "wheel-slip", "without a position"));
    for (const ParameterId id : {ParameterId::kMassNorm, ParameterId::kSurgeBeta}) {
      EXPECT_TRUE(result->model[id].value && !result->model[id].std_error) << info(id).name;
    }
    EXPECT_EQ(result->model[ParameterId::kYawAlpha].std_error.has_value(), !of_yaw);
  }
}

TEST(LateLog, WithdrawsTheMassIfSlipResemblesLateCommands) {
  // Wheel slip changes the measured speed as if it were read early. Late commands together with a
  // late yaw rate have the same effect, so the log does not show which of the two is the cause.
  DrivingLog log = with_slip(
      drive(kTruths[1], 8, {.duration_s = 20.0, .rate_hz = 50.0}, kPreciseSensors), 0.02, false);
  remove_pose(log);
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "wheel-slip", "do not decide between"));
  EXPECT_TRUE(has_finding(*result, "wheel-slip", "late time stamps of the commands"));
  EXPECT_TRUE(has_finding(*result, "wheel-slip", "mass_norm"));
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].std_error);
}

/// Test parameter: true for slip in the yaw rate too.
INSTANTIATE_TEST_SUITE_P(Short, SlippingWheels, ::testing::Bool());
INSTANTIATE_TEST_SUITE_P(Long, SlippingWheels, ::testing::Bool());

/// The log without its first rows.
DrivingLog cut(DrivingLog log, std::size_t rows) {
  const auto shorten = [&](std::vector<double>& values) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows));
  };
  for (std::vector<double>* const values :
       {&log.t_s, &log.force_left, &log.force_right, &*log.steering_command_rad}) {
    shorten(*values);
  }
  for (const LogChannel channel : kChannels) {
    if (!log[channel]) continue;
    shorten(log[channel]->value);
    log[channel]->fresh.erase(log[channel]->fresh.begin(),
                              log[channel]->fresh.begin() + static_cast<std::ptrdiff_t>(rows));
  }
  return log;
}

TEST(LateLog, DoesNotFitTheFirstSecondOfALogThatBeginsInMotion) {
  const std::vector<DrivingLog> from_rest = {drive(kTruths[1], 8)};
  EXPECT_EQ(fit_windows(from_rest, kWindow_s).front().rows.begin, 0U);
  constexpr std::size_t kCut = 600;
  ASSERT_GT(from_rest[0][LogChannel::kSpeed]->value[kCut], 0.1);
  const std::vector<DrivingLog> in_motion = {cut(from_rest[0], kCut)};
  EXPECT_EQ(fit_windows(in_motion, kWindow_s).front().rows.begin, 100U);
}

TEST(LateLog, EveryDelayOfAFitIsFreeInTheFitsOfItsParts) {
  LogFit fit;
  fit.quantities = {free_term(FreeQuantity::Kind::kSteeringDelay),
                    free_term(FreeQuantity::Kind::kMotorLag),
                    free_term(FreeQuantity::Kind::kSensorDelay, LogChannel::kX),
                    sensor_lag_of(LogChannel::kSpeed),
                    free_term(FreeQuantity::Kind::kSteeringTrim),
                    free_term(FreeQuantity::Kind::kForceImbalance),
                    force_saturation(0.5),
                    free_term(FreeQuantity::Kind::kSaturationSharpness)};
  fit.coordinates = {0.1, 0.2, 0.3, 0.4, 0.05, -0.1, 0.3, 1.1};
  LogFitOptions before;
  before.terms = {{sensor_lag_of(LogChannel::kYawRate), 0.5}};
  const LogFitOptions options = with_terms_of(fit, before);
  const std::vector<FreeTerm>& terms = options.terms;
  ASSERT_EQ(terms.size(), fit.quantities.size());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    EXPECT_EQ(terms[i].quantity.name(), fit.quantities[i].name());
    EXPECT_EQ(terms[i].begin, fit.coordinates[i]);
  }
  // Expected order: the terms of the commands come before those of the sensors.
  EXPECT_EQ(initial_coordinates(options), (std::vector{0.1, 0.2, 0.05, -0.1, 0.3, 1.1, 0.3, 0.4}));
}

/// Expects that the fit of a log with an error of the motors or the steering estimates the error,
/// reports its finding, and estimates the true parameters.
void expect_found(DrivingLog log, const Truth& truth, const std::string& name, double value,
                  const std::string& code, const IdentifyOptions& options = {}) {
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, options, {});
  ASSERT_TRUE(result);
  expect_estimated(*result, name, value);
  EXPECT_TRUE(has_finding(*result, code));
  EXPECT_FALSE(has_finding(*result, "model-inadequate"));
  expect_recovered(*result, ParameterId::kMassNorm, truth.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, truth.a1, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * truth.mass_norm, 4.5);
}

class SteeringTrim : public ::testing::TestWithParam<double> {};

TEST_P(SteeringTrim, IsFound) {
  const double trim_rad = GetParam();
  DrivingLog log = precise_drive(kTruths[1]);
  for (double& command : *log.steering_command_rad) command -= trim_rad;
  expect_found(std::move(log), kTruths[1], "steering.trim_rad", trim_rad, "steering-trim",
               options_of_instance());
}
INSTANTIATE_TEST_SUITE_P(Short, SteeringTrim, ::testing::Values(-0.03));
/// Long tests: a choice of the families, the other sign and a larger value.
INSTANTIATE_TEST_SUITE_P(Long, SteeringTrim, ::testing::Values(-0.03, 0.07));

TEST_P(LateLogs, FindsAServoThatIsSlowerThanTheVehicleFileSays) {
  const Truth& t = kTruths[1];
  constexpr double kRate_radps = 1.0;
  ASSERT_GT(radians(robot().steering_max_rate_degps), 4.0 * kRate_radps);
  Plant<double> slow = plant(t);
  slow.steering_max_rate_radps = kRate_radps;
  Random random(8, 5);
  DrivingLog log = simulate_log(slow, robot(), {.duration_s = 10.0, .rate_hz = 50.0, .drive = 8},
                                kVeryPreciseSensors, random);
  expect_found(std::move(log), t, "steering.max_rate_radps", kRate_radps, "servo-rate", options());
}

TEST(LateLog, WithdrawsTheIntervalsOfLogsWithDifferentTrims) {
  TrialData data;
  for (const auto& [trim_rad, seed] : {std::pair(0.08, 8), std::pair(-0.06, 9)}) {
    data.logs.push_back(drive(kTruths[1], seed, {.duration_s = 10.0}));
    for (double& command : *data.logs.back().steering_command_rad) command -= trim_rad;
    data.logs.back().file = std::to_string(seed);
  }
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "logs-disagree", "steering.trim_rad"));
  EXPECT_FALSE(result->model[ParameterId::kInertiaNorm].ci95);
}

TEST(LateLog, DetectsASteeringCommandThatIsTheMeasuredAngle) {
  const Truth& t = kTruths[1];
  Plant<double> slow = plant(t);
  slow.steering_time_constant_s = 0.1;
  Random random(8, 5);
  DrivingLog log = simulate_log(slow, robot(), {.duration_s = 10.0, .rate_hz = 50.0, .drive = 8},
                                kPreciseSensors, random);
  std::vector<double> angle(log.rows());
  replay<double>(LogSignals(log), 0, log.rows(), slow, nullptr, 0.002, {},
                 [&](std::size_t row, const State<double>& s) { angle[row] = s.steering_rad; });
  log[LogChannel::kSteering].reset();
  TrialData as_logged;
  as_logged.logs = {log};
  const auto command = identify(robot(), as_logged, power_law(), {});
  ASSERT_TRUE(command);
  EXPECT_FALSE(has_finding(*command, "steering-measured"));
  expect_recovered(*command, ParameterId::kSteeringTimeConstant, 0.1, 4.5);

  as_logged.logs[0].steering_command_rad = angle;
  const auto result = identify(robot(), as_logged, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "steering-measured"));
  EXPECT_FALSE(result->model[ParameterId::kSteeringTimeConstant].source == Source::kFitted);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kYawAlpha, t.a3, 4.5);
}

/// Smooth commands, with a row every `step_s`.
DrivingLog smooth_commands(double step_s, double duration_s = 10.0) {
  DrivingLog log;
  log.steering_command_rad.emplace();
  const auto rows = static_cast<std::size_t>(duration_s / step_s);
  for (std::size_t i = 0; i < rows; ++i) {
    const double t_s = step_s * static_cast<double>(i);
    log.t_s.push_back(t_s);
    const double force = 0.25 + 0.12 * std::sin(0.9 * t_s) + 0.08 * std::sin(2.3 * t_s + 1.0);
    log.force_left.push_back(force);
    log.force_right.push_back(force);
    log.steering_command_rad->push_back(0.15 * std::sin(1.7 * t_s) + 0.1 * std::sin(4.1 * t_s));
  }
  return log;
}

/// Simulates the vehicle with the commands of `fast`. Returns a log with every `every`-th row:
/// commands and measurements with noise of the standard deviation `noise_std` (m/s, rad/s, rad).
DrivingLog measured_rows(const DrivingLog& fast, const Plant<double>& vehicle, std::size_t every,
                         double noise_std = 0.005) {
  std::vector<State<double>> states;
  replay<double>(LogSignals(fast), 0, fast.rows(), vehicle, nullptr, 0.002, {},
                 [&](std::size_t, const State<double>& s) { states.push_back(s); });
  Random random(4, 2);
  return thinned(fast, every, {LogChannel::kHeading, LogChannel::kSpeed, LogChannel::kYawRate},
                 [&](LogChannel channel, std::size_t i) {
                   return channel_of(states[i], channel) + noise_std * random.normal();
                 });
}

TEST_P(LateLogs, InterpolatesCommandsThatChangeFasterThanTheRows) {
  const Truth& t = kTruths[1];
  TrialData data;
  data.logs = {measured_rows(smooth_commands(0.01), plant(t), 5)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "interpolated-commands"));
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
}

/// Keeps only every `rows`-th command and holds it until the next one.
void hold_commands(DrivingLog& log, std::size_t rows) {
  for (std::vector<double>* const signal :
       {&log.force_left, &log.force_right, &*log.steering_command_rad}) {
    for (std::size_t i = 0; i < signal->size(); ++i) (*signal)[i] = (*signal)[i - i % rows];
  }
}

/// Interpolates the signal linearly between its values in every `rows`-th row.
std::vector<double> on_lines(const std::vector<double>& signal, std::size_t rows) {
  std::vector<double> lines = signal;
  for (std::size_t i = 0; i + rows < signal.size(); ++i) {
    const std::size_t from = i - i % rows;
    const double share = static_cast<double>(i % rows) / static_cast<double>(rows);
    lines[i] = signal[from] + share * (signal[from + rows] - signal[from]);
  }
  return lines;
}

/// Log with rows every 20 ms and commands that are held for `rows` times 4 ms. They change between
/// the rows unless `rows` is a multiple of 5.
DrivingLog sampled_steps(std::size_t rows) {
  DrivingLog fast = smooth_commands(0.004, 15.0);
  hold_commands(fast, rows);
  return measured_rows(fast, plant(kTruths[1]), 5);
}

TEST(LateLog, EstimatesTheTimesOfCommandsThatChangeBetweenRows) {
  const Truth& t = kTruths[1];
  for (const std::size_t rows : {163U, 165U}) {
    TrialData data;
    data.logs = {sampled_steps(rows)};
    const auto result = identify(robot(), data, {}, {});
    ASSERT_TRUE(result);
    EXPECT_EQ(has_finding(*result, "changes-between-rows"), rows % 5 != 0) << rows;
    for (const char* code : {"late-commands", "actuator-lag", "sensor-delay", "wheel-slip",
                             "force-saturation", "power-law-inadequate", "model-inadequate"}) {
      EXPECT_FALSE(has_finding(*result, code)) << code << ' ' << rows;
    }
    expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
    expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
    expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
    expect_recovered(*result, ParameterId::kYawAlpha, t.a3, 4.5);
    expect_recovered(*result, ParameterId::kSteeringTimeConstant, plant(t).steering_time_constant_s,
                     4.5);
  }
}

/// A controller at 100 Hz and a log at 50 Hz: half of the commands change at a row, the others in
/// the middle between two rows. The speed is measured in every `rows_per_speed`-th row.
void expect_finds_half_of_changes_between_rows(std::size_t rows_per_speed) {
  const Truth& t = kTruths[1];
  Plant<double> slow_servo = plant(t);
  slow_servo.steering_time_constant_s = 0.15;
  DrivingLog fast = smooth_commands(0.01, 30.0);
  hold_commands(fast, 131);
  DrivingLog log = measured_rows(fast, slow_servo, 2);
  keep_every(rows_per_speed, *log[LogChannel::kSpeed]);
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "changes-between-rows"));
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  EXPECT_FALSE(has_finding(*result, "side-pull"));
  expect_recovered(*result, ParameterId::kYawAlpha, t.a3, 3.0);
  expect_recovered(*result, ParameterId::kYawBeta, t.b3, 3.0);
  expect_recovered(*result, ParameterId::kSteeringTimeConstant, 0.15, 3.0);
}

TEST(LateLog, FindsThatHalfOfTheCommandsChangeBetweenRows) {
  expect_finds_half_of_changes_between_rows(1);
}

TEST(LateLog, FindsChangesBetweenRowsAlthoughTheSpeedIsSlow) {
  expect_finds_half_of_changes_between_rows(10);
}

/// Rows every 0.1 s: the servo's time constant is 0.06 s, so that the unknown times of the commands
/// matter, and neither it nor a short delay can be told from them.
TEST(LateLog, GivesNoIntervalToAServoThatIsFastForTheRows) {
  Plant<double> vehicle = plant(kTruths[1]);
  vehicle.steering_time_constant_s = 0.06;
  DrivingLog fast = smooth_commands(0.01, 30.0);
  hold_commands(fast, 113);
  TrialData data;
  data.logs = {measured_rows(fast, vehicle, 10)};
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "changes-between-rows"));
  EXPECT_FALSE(result->model[ParameterId::kSteeringTimeConstant].std_error);
  for (const char* code : {"sensor-delay", "actuator-lag"}) {
    EXPECT_FALSE(has_finding(*result, code)) << code;
  }
}

TEST_P(LateLogs, EstimatesTheTimesOfChangesTogetherWithAMotorLag) {
  constexpr double kLag_s = 0.1;
  constexpr std::size_t kRowsHeld = 163;
  const Truth& t = kTruths[1];
  DrivingLog fast = smooth_commands(0.004, 15.0);
  hold_commands(fast, kRowsHeld);
  DrivingLog lagged = fast;
  for (std::vector<double>* const force : {&lagged.force_left, &lagged.force_right}) {
    *force = behind_motors(fast, *force, kLag_s, force->front());
  }
  DrivingLog log = measured_rows(lagged, plant(t), 5);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.force_left[i] = fast.force_left[5 * i];
    log.force_right[i] = fast.force_right[5 * i];
  }
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "changes-between-rows"));
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  expect_estimated(*result, "motor.time_constant_s", kLag_s);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
}

TEST(LateLog, EstimatesTheTimesOfChangesTogetherWithBackEmf) {
  constexpr double kBackEmf_s_per_m = 0.1;
  constexpr std::size_t kRowsHeld = 163;
  const Truth& t = kTruths[1];
  DrivingLog fast = smooth_commands(0.004, 30.0);
  hold_commands(fast, kRowsHeld);
  for (std::size_t i = 0; i < fast.rows(); ++i) {  // coasts in every fourth period
    if (i / kRowsHeld % 4 == 3) fast.force_left[i] = fast.force_right[i] = 0.0;
  }
  Plant<double> geared = plant(t);
  geared.back_emf_s_per_m = kBackEmf_s_per_m;
  TrialData data;
  data.logs = {measured_rows(fast, geared, 5, 0.007)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "changes-between-rows"));
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  expect_recovered(*result, ParameterId::kBackEmf, kBackEmf_s_per_m, 4.5);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
  expect_recovered(*result, ParameterId::kSteeringTimeConstant, plant(t).steering_time_constant_s,
                   4.5);
}

/// Both resistances have Coulomb friction, so the first fit, of power laws, does not describe the
/// log.
TEST(LateLog, EstimatesTheTimesOfChangesTogetherWithCoulombFriction) {
  constexpr double kYawCoulomb_m = 0.03;
  const Truth& t = kTruths[1];
  Plant<double> rubbing = plant(t);
  rubbing.surge.coulomb = 0.3;
  rubbing.yaw.coulomb = kYawCoulomb_m;
  const DrivingLog fast = drive(t, 8, {.duration_s = 20.0, .rate_hz = 250.0});
  TrialData data;
  data.logs = {measured_rows(fast, rubbing, 13, 0.0078)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "changes-between-rows"));
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  expect_recovered(*result, ParameterId::kYawCoulomb, kYawCoulomb_m, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
}

TEST_P(LateLogs, HoldsSetPointsThatWereInterpolatedInTheLog) {
  constexpr std::size_t kRowsHeld = 5;
  const Truth& t = kTruths[1];
  DrivingLog fast = smooth_commands(0.02);
  hold_commands(fast, kRowsHeld);
  DrivingLog log = measured_rows(fast, plant(t), 1);
  for (std::vector<double>* const signal :
       {&log.force_left, &log.force_right, &*log.steering_command_rad}) {
    *signal = on_lines(*signal, kRowsHeld);
  }
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "interpolated-set-points"));
  EXPECT_FALSE(has_finding(*result, "interpolated-commands"));
  EXPECT_FALSE(has_finding(*result, "late-commands"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

TEST(LateLog, FindsAGyroscopeThatReadsTooMuch) {
  constexpr double kScale = 0.04;
  DrivingLog log = precise_drive(kTruths[1]);
  for (double& reading : log[LogChannel::kYawRate]->value) reading *= 1.0 + kScale;
  expect_found(std::move(log), kTruths[1], "scale.yaw_rate_radps", kScale, "sensor-scale");
}

TEST(LateLog, FindsASpeedThatReadsTooLittle) {
  constexpr double kScale = -0.02;
  DrivingLog log = precise_drive(kTruths[1]);
  for (double& reading : log[LogChannel::kSpeed]->value) reading *= 1.0 + kScale;
  expect_found(std::move(log), kTruths[1], "scale.speed_mps", kScale, "sensor-scale");
}

TEST_P(LateLogs, FindsADeadBandOfTheSteering) {
  constexpr double kBand_rad = 0.03;
  DrivingLog log = precise_drive(kTruths[1]);
  // The commands with which a vehicle with the dead band would have made the same drive.
  for (double& command : *log.steering_command_rad) {
    if (command != 0.0) command += std::copysign(kBand_rad, command);
  }
  expect_found(std::move(log), kTruths[1], "steering.dead_band_rad", kBand_rad,
               "steering-dead-band", options());
}

TEST_P(LateLogs, FindsSteeringThatIsNotSymmetric) {
  constexpr double kAsymmetry = 0.1;
  DrivingLog log = precise_drive(kTruths[1]);
  for (double& command : *log.steering_command_rad) {
    command /= 1.0 + std::copysign(kAsymmetry, command);
  }
  expect_found(std::move(log), kTruths[1], "steering.asymmetry", kAsymmetry, "steering-asymmetry",
               options());
}

class ForceImbalance : public ::testing::TestWithParam<double> {};

TEST_P(ForceImbalance, IsFound) {
  const double imbalance = GetParam();
  DrivingLog log = precise_drive(kTruths[1]);
  for (double& force : log.force_left) force /= 1.0 - imbalance;
  for (double& force : log.force_right) force /= 1.0 + imbalance;
  expect_found(std::move(log), kTruths[1], "motor.imbalance", imbalance, "force-imbalance",
               options_of_instance());
}
INSTANTIATE_TEST_SUITE_P(Short, ForceImbalance, ::testing::Values(0.05));
/// Long tests: a choice of the families, the other sign and a larger value.
INSTANTIATE_TEST_SUITE_P(Long, ForceImbalance, ::testing::Values(0.05, -0.1));

TEST(LargeForceImbalance, WithdrawsTheIntervals) {
  constexpr double kImbalance = 0.3;
  TrialData data;
  data.logs = {long_drive(kTruths[1])};
  for (double& force : data.logs[0].force_left) force /= 1.0 - kImbalance;
  for (double& force : data.logs[0].force_right) force /= 1.0 + kImbalance;
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "force-imbalance"));
  ASSERT_TRUE(result->model[ParameterId::kMassNorm].value);
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].ci95);
}

/// The log of a vehicle whose motors saturate: a command F' gives the force
///   F'/(1 + s (F'/F'm)^n)^(1/n),   s = (1 - L)^(-n) - 1
/// F'm is the largest command, and L (`loss`) the fraction of the force that is lost at F'm. The
/// commands are increased so that the forces stay those of `log`.
DrivingLog saturated(DrivingLog log, double loss, double n) {
  double most = 0.0;  // largest force after the saturation
  for (const auto* const forces : {&log.force_left, &log.force_right}) {
    for (const double force : *forces) most = std::max(most, std::abs(force));
  }
  const double full = most / (1.0 - loss);
  const double s = std::pow(1.0 - loss, -n) - 1.0;
  for (auto* const forces : {&log.force_left, &log.force_right}) {
    for (double& force : *forces) {
      force *= std::pow(1.0 - s * std::pow(std::abs(force) / full, n), -1.0 / n);
    }
  }
  return log;
}

TEST_P(LateLogs, FindsASmallSaturationOfTheForces) {
  constexpr double kLoss = 0.035;
  expect_found(saturated(precise_drive(kTruths[1]), kLoss, 4.0), kTruths[1], "motor.saturation",
               kLoss, "force-saturation", options());
}

class ForceSaturation : public ::testing::TestWithParam<double> {};

/// A loss of more than 5 % is compensated, but the intervals are withdrawn.
TEST_P(ForceSaturation, IsCompensatedWithoutIntervals) {
  const Truth& truth = kTruths[1];
  TrialData data;
  data.logs = {saturated(precise_drive(truth), 0.16, GetParam())};
  const auto result = identify(robot(), data, options_of_instance(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "force-saturation"));
  const std::pair<ParameterId, double> truths[] = {
      {ParameterId::kMassNorm, truth.mass_norm},
      {ParameterId::kSurgeAlpha, truth.a1},
      {ParameterId::kInertiaNorm, 0.16 * truth.mass_norm}};
  for (const auto& [id, value] : truths) {
    EXPECT_NEAR(result->model[id].value.value_or(0.0), value, 0.05 * value) << info(id).name;
    EXPECT_FALSE(result->model[id].ci95) << info(id).name;
  }
}
/// Exponent of the command in the wheel force.
class ForceExponent : public ::testing::TestWithParam<double> {};

TEST_P(ForceExponent, IsFound) {
  const double p = GetParam();
  const Truth& truth = kTruths[1];
  DrivingLog log = drive(truth, 8, {.duration_s = 15.0, .rate_hz = 40.0}, kPreciseSensors);
  for (auto* const forces : {&log.force_left, &log.force_right}) {
    for (double& force : *forces) {
      force = std::copysign(std::pow(std::abs(force), 1.0 / p), force);
    }
  }
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, p < 1.0 ? "force-saturation" : "force-curve"));
  const auto exponent = estimated(*result, "motor.exponent");
  ASSERT_TRUE(exponent);
  EXPECT_NEAR(exponent->value, p, 0.025 * p);
  EXPECT_FALSE(has_finding(*result, "model-inadequate"));
  const Estimate& mass = result->model[ParameterId::kMassNorm];
  EXPECT_NEAR(mass.value.value_or(0.0), truth.mass_norm, 0.02 * truth.mass_norm);
  EXPECT_FALSE(mass.ci95);
}
INSTANTIATE_TEST_SUITE_P(Some, ForceExponent, ::testing::Values(0.8, 1.5));

/// The motors saturate like tanh, which the fitted saturation does not describe exactly. The
/// estimates therefore differ between logs. This difference must not be reported.
TEST(LateLog, DoesNotCompareLogsWithALargeSaturation) {
  TrialData data;
  for (const std::uint64_t seed : {8U, 9U}) {
    DrivingLog log = drive(kTruths[1], seed, {.duration_s = 8.0, .rate_hz = 40.0});
    for (auto* const forces : {&log.force_left, &log.force_right}) {
      for (double& force : *forces) force = 0.9 * std::atanh(std::clamp(force, -0.8, 0.8) / 0.9);
    }
    log.file = std::to_string(seed);
    data.logs.push_back(std::move(log));
  }
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "force-saturation", "not compared"));
  EXPECT_FALSE(has_finding(*result, "logs-disagree", ""));
}

INSTANTIATE_TEST_SUITE_P(Short, ForceSaturation, ::testing::Values(4.0));
/// Sharpness n of the saturation: from a gradual loss of force (1) to nearly a hard limit (20).
INSTANTIATE_TEST_SUITE_P(Long, ForceSaturation, ::testing::Values(1.0, 2.0, 4.0, 20.0));

TEST(LateLog, GivesTheSameBytesOnALoadedMachine) {
  TrialData data;
  data.logs = {drive(kTruths[0], 11, {.duration_s = 8.0, .rate_hz = 50.0})};
  const std::string idle = model_text(identify(robot(), data, {}, {})->model);
  std::atomic<bool> is_over = false;
  std::vector<std::jthread> busy;
  for (unsigned i = 0; i < 2 * std::thread::hardware_concurrency(); ++i) {
    busy.emplace_back([&] {
      while (!is_over) {
      }
    });
  }
  const std::string loaded = model_text(identify(robot(), data, {}, {})->model);
  is_over = true;
  EXPECT_EQ(idle, loaded);
}

}  // namespace
}  // namespace awmr::testing
