/// Logs of vehicles whose firmware ramps the commands, changes them in cycles, or computes speed
/// and yaw rate by a tracking filter; and logs with a wrong scale of the gyroscope.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "awmr/trials/log_start.h"
#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

const Truth& kFirmwareTruth = kTruths[1];
constexpr double kFastStep_s = 0.004;  // row spacing of the simulated logs, before thinning

DrivingLog fast_drive(double duration_s) {
  return drive(kFirmwareTruth, 8, {.duration_s = duration_s, .rate_hz = 1.0 / kFastStep_s});
}

std::vector<State<double>> motion_of(const DrivingLog& log) {
  std::vector<State<double>> states;
  replay<double>(LogSignals(log), 0, log.rows(), plant(kFirmwareTruth), nullptr, kSimulationStep_s,
                 {}, [&](std::size_t, const State<double>& state) { states.push_back(state); });
  return states;
}

const std::vector<LogChannel> kSpeedAndYawRate = {LogChannel::kSpeed, LogChannel::kYawRate};

/// Readings with white noise of this standard deviation (m/s, rad/s).
Reading noisy(std::vector<State<double>> states, double noise_std) {
  return [states = std::move(states), noise_std, random = Random(4, 2)](LogChannel channel,
                                                                        std::size_t i) mutable {
    return channel_of(states[i], channel) + noise_std * random.normal();
  };
}

Identification fit_of_firmware(DrivingLog log, const IdentifyOptions& options = power_law()) {
  TrialData data;
  data.logs = {std::move(log)};
  auto result = identify(robot(), data, options, {});
  EXPECT_TRUE(result);
  return result ? *std::move(result) : Identification{};
}

void expect_vehicle_of_log(const Identification& result) {
  expect_recovered(result, ParameterId::kMassNorm, kFirmwareTruth.mass_norm, 4.0);
  expect_recovered(result, ParameterId::kInertiaNorm, 0.16 * kFirmwareTruth.mass_norm, 4.0);
  expect_recovered(result, ParameterId::kSurgeAlpha, kFirmwareTruth.a1, 4.0);
  expect_recovered(result, ParameterId::kSurgeBeta, kFirmwareTruth.b1, 4.0);
  expect_recovered(result, ParameterId::kYawAlpha, kFirmwareTruth.a3, 4.0);
}

/// Estimate of the rate of `position` by an alpha-beta filter, which predicts and corrects position
/// and rate in steps of h_s seconds.
std::vector<double> tracked_rate(const std::vector<double>& position, double h_s, double alpha,
                                 double beta) {
  double estimate = position.front();
  double rate = 0.0;
  std::vector<double> rates;
  for (const double measured : position) {
    estimate += h_s * rate;
    const double error = measured - estimate;
    estimate += alpha * error;
    rate += beta / h_s * error;
    rates.push_back(rate);
  }
  return rates;
}

/// Distance or angle (the integral of the channel) at every `every`-th state.
std::vector<double> positions_of(const std::vector<State<double>>& states, LogChannel channel,
                                 std::size_t every) {
  std::vector<double> positions;
  double exact = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (i > 0) {
      exact +=
          0.5 * kFastStep_s * (channel_of(states[i - 1], channel) + channel_of(states[i], channel));
    }
    if (i % every == 0) positions.push_back(exact);
  }
  return positions;
}

/// Log with rows every `every` fast rows, whose speed and yaw rate come from alpha-beta filters of
/// the distance and the angle, which have white noise (m, rad).
DrivingLog tracked_log(std::size_t every, double alpha, double beta, double noise_std) {
  const DrivingLog fast = fast_drive(10.0);
  const std::vector<State<double>> states = motion_of(fast);
  Random random(4, 2);
  std::map<LogChannel, std::vector<double>> rates;
  for (const LogChannel channel : kSpeedAndYawRate) {
    std::vector<double> position = positions_of(states, channel, every);
    for (double& one : position) one += noise_std * random.normal();
    rates[channel] = tracked_rate(position, kFastStep_s * static_cast<double>(every), alpha, beta);
  }
  return thinned(fast, every, kSpeedAndYawRate,
                 [&](LogChannel channel, std::size_t i) { return rates[channel][i / every]; });
}

TEST(FirmwareLog, SpeedAndYawRateOfATrackingFilterAreAllowedFor) {
  const Identification result = fit_of_firmware(tracked_log(8, 0.3, 0.12, 0.00105));
  EXPECT_TRUE(has_finding(result, "sensor-lag", "second order"));
  EXPECT_FALSE(has_finding(result, "actuator-lag"));
  EXPECT_FALSE(has_finding(result, "smoothed-channel"));
  // beta = (1 - e_1)(1 - e_2) and alpha = 1 - e_1 e_2 give T = 2.632 rows and zeta = 0.469.
  const auto lag = estimated(result, "lag.speed_mps");
  ASSERT_TRUE(lag && lag->std_error);
  EXPECT_NEAR(lag->value, 0.0842, 4.0 * *lag->std_error);
  expect_vehicle_of_log(result);
}

/// Log with rows every `every` fast rows, at which the commands change. The speed is the distance
/// in whole counts of `count_m` since the row before, divided by the time; the yaw rate is that of
/// a gyroscope.
DrivingLog counted_log(std::size_t every, double count_m) {
  DrivingLog fast = fast_drive(10.0);
  for (std::size_t i = 0; i < fast.rows(); ++i) {
    const std::size_t from = i - i % every;
    fast.force_left[i] = fast.force_left[from];
    fast.force_right[i] = fast.force_right[from];
    (*fast.steering_command_rad)[i] = (*fast.steering_command_rad)[from];
  }
  const std::vector<State<double>> states = motion_of(fast);
  std::vector<double> counted_m = positions_of(states, LogChannel::kSpeed, every);
  for (double& one : counted_m) one = count_m * std::floor(one / count_m);
  const double row_s = kFastStep_s * static_cast<double>(every);
  const Reading gyroscope = noisy(states, 0.0035);
  const auto reading = [&](LogChannel channel, std::size_t i) {
    if (channel == LogChannel::kYawRate) return gyroscope(channel, i);
    const std::size_t row = i / every;
    return row == 0 ? 0.0 : (counted_m[row] - counted_m[row - 1]) / row_s;
  };
  DrivingLog log = thinned(fast, every, kSpeedAndYawRate, reading);
  add_row_of_rest(log);
  return log;
}

TEST(FirmwareLog, SpeedOfEncoderCountsIsTheMeanSinceTheRowBefore) {
  const Identification result = fit_of_firmware(counted_log(10, 2e-4));
  EXPECT_TRUE(has_finding(result, "averaged-channel"));
  for (const char* wrong : {"sensor-lag", "sensor-delay", "actuator-lag", "smoothed-channel"}) {
    EXPECT_FALSE(has_finding(result, wrong)) << wrong;
  }
  const auto averaging = estimated(result, "averaging.speed_mps");
  ASSERT_TRUE(averaging && averaging->std_error);
  EXPECT_NEAR(averaging->value, 0.04, 4.0 * *averaging->std_error);
  expect_vehicle_of_log(result);
}

/// Force of a motor whose controller lets the magnitude of the command rise by at most `rise` per
/// second and fall by at most `fall` per second. Mean over each row of the fast log.
std::vector<double> ramped_force(const std::vector<double>& command, double rise, double fall) {
  double force = command.front();
  std::vector<double> forces;
  for (const double target : command) {
    double left_s = kFastStep_s;
    double integral_s = 0.0;
    while (left_s > 0.0 && force != target) {
      const bool turns = force * target < 0.0;
      const bool falls = turns || std::abs(target) < std::abs(force);
      const double until = turns ? 0.0 : target;
      const double most = left_s * (falls ? fall : rise);
      const double gap = until - force;
      const double step = std::clamp(gap, -most, most);
      const double lasts_s = std::abs(step) / (falls ? fall : rise);
      integral_s += lasts_s * (force + 0.5 * step);
      force += step;
      left_s -= lasts_s;
      if (std::abs(step) < std::abs(gap)) left_s = 0.0;
    }
    forces.push_back((integral_s + left_s * force) / kFastStep_s);
  }
  return forces;
}

class RampedLogs : public FitOfInstance {};
INSTANTIATE_TEST_SUITE_P(Short, RampedLogs, ::testing::Values(false));
INSTANTIATE_TEST_SUITE_P(Long, RampedLogs, ::testing::Values(true));

DrivingLog ramped_log(double duration_s, double rise, double fall) {
  const DrivingLog fast = fast_drive(duration_s);
  DrivingLog motors = fast;
  motors.force_left = ramped_force(fast.force_left, rise, fall);
  motors.force_right = ramped_force(fast.force_right, rise, fall);
  return thinned(fast, 5, kSpeedAndYawRate, noisy(motion_of(motors), 0.005));
}

TEST_P(RampedLogs, SoftStartIsEstimated) {
  constexpr double kRise_per_s = 1.0;
  const Identification result = fit_of_firmware(ramped_log(12.5, kRise_per_s, 1e9), options());
  EXPECT_TRUE(has_finding(result, "force-ramp", "rises"));
  EXPECT_FALSE(has_finding(result, "force-ramp", "falls"));
  EXPECT_FALSE(has_finding(result, "actuator-lag"));
  const auto rise = estimated(result, "motor.rise_time_s");
  ASSERT_TRUE(rise && rise->std_error);
  EXPECT_NEAR(rise->value, 1.0 / kRise_per_s, 4.0 * *rise->std_error);
  expect_vehicle_of_log(result);
}

TEST_P(RampedLogs, SlewRateLimitOfRiseAndFallIsEstimated) {
  constexpr double kRise_per_s = 1.2;
  constexpr double kFall_per_s = 2.0;
  const Identification result =
      fit_of_firmware(ramped_log(18.0, kRise_per_s, kFall_per_s), options());
  for (const auto& [name, rate] :
       {std::pair("motor.rise_time_s", kRise_per_s), std::pair("motor.fall_time_s", kFall_per_s)}) {
    const auto time = estimated(result, name);
    ASSERT_TRUE(time && time->std_error) << name;
    EXPECT_NEAR(time->value, 1.0 / rate, 4.0 * *time->std_error) << name;
  }
  EXPECT_FALSE(has_finding(result, "actuator-lag"));
  expect_vehicle_of_log(result);
}

// A controller with a cycle of half a row spacing changes its commands at the rows or in the middle
// between them, on average a quarter of the spacing before the row with the new command.
TEST(FirmwareLog, ChangesInCyclesBetweenRowsAreNotADeadTime) {
  constexpr std::size_t kEvery = 10;
  constexpr std::size_t kCycle = 5;
  DrivingLog fast = fast_drive(12.5);
  for (std::vector<double>* const signal :
       {&fast.force_left, &fast.force_right, &*fast.steering_command_rad}) {
    const std::vector<double> all = *signal;
    for (std::size_t i = 0; i < all.size(); ++i) (*signal)[i] = all[i - i % kCycle];
  }
  const Identification result =
      fit_of_firmware(thinned(fast, kEvery, kSpeedAndYawRate, noisy(motion_of(fast), 0.0028)));
  EXPECT_FALSE(has_finding(result, "actuator-lag"));
  EXPECT_FALSE(has_finding(result, "late-commands"));
  expect_vehicle_of_log(result);
}

/// Log with a gyroscope that reads 1 + `scale` times the yaw rate, and a heading with this noise.
DrivingLog log_of_gyroscope(double scale, double heading_std_rad) {
  const DrivingLog fast = fast_drive(12.5);
  const std::vector<State<double>> states = motion_of(fast);
  Random random(4, 2);
  return thinned(fast, 5, {LogChannel::kHeading, LogChannel::kSpeed, LogChannel::kYawRate},
                 [&](LogChannel channel, std::size_t i) {
                   const double exact = channel_of(states[i], channel);
                   if (channel == LogChannel::kHeading)
                     return exact + heading_std_rad * random.normal();
                   const bool is_scaled = channel == LogChannel::kYawRate;
                   return (is_scaled ? 1.0 + scale : 1.0) * exact + 0.0021 * random.normal();
                 });
}

TEST(FirmwareLog, IntervalsAllowForAGyroScaleThatTheHeadingLeavesOpen) {
  for (const double scale : {-0.02, 0.02}) {
    const Identification result = fit_of_firmware(log_of_gyroscope(scale, 1.0));
    // The noise of the heading decides whether the scale is estimated or open.
    EXPECT_TRUE(has_finding(result, "gyro-scale-open") || has_finding(result, "sensor-scale"))
        << scale;
    for (const ParameterId id : {ParameterId::kInertiaNorm, ParameterId::kYawAlpha}) {
      const Estimate& estimate = result.model[id];
      ASSERT_TRUE(estimate.value && estimate.std_error);
      const double truth =
          id == ParameterId::kYawAlpha ? kFirmwareTruth.a3 : 0.16 * kFirmwareTruth.mass_norm;
      EXPECT_NEAR(*estimate.value, truth, 2.6 * *estimate.std_error) << info(id).name;
      EXPECT_LT(*estimate.std_error, 0.02 * truth) << info(id).name;
    }
    expect_recovered(result, ParameterId::kMassNorm, kFirmwareTruth.mass_norm, 4.0);
  }
}

// Without a heading, the initial heading of each window is known only from the fit.
TEST(FirmwareLog, PositionsDecideTheGyroScale) {
  TrialData data;
  data.logs = {drive(kFirmwareTruth, 8, {.duration_s = 20.0, .rate_hz = 50.0}, kPreciseSensors)};
  data.logs.front()[LogChannel::kHeading].reset();
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  const Estimate& inertia = result->model[ParameterId::kInertiaNorm];
  ASSERT_TRUE(inertia.std_error);
  EXPECT_LT(*inertia.std_error, 0.015 * *inertia.value);
  expect_vehicle_of_log(*result);
}

TEST(FirmwareLog, APreciseHeadingLeavesNoGyroScaleOpen) {
  const Identification result = fit_of_firmware(log_of_gyroscope(0.0, 0.003));
  EXPECT_FALSE(has_finding(result, "gyro-scale-open"));
  expect_recovered(result, ParameterId::kInertiaNorm, 0.16 * kFirmwareTruth.mass_norm, 4.0);
  const Estimate& inertia = result.model[ParameterId::kInertiaNorm];
  EXPECT_LT(*inertia.std_error, 0.01 * *inertia.value);
}

}  // namespace
}  // namespace awmr::testing
