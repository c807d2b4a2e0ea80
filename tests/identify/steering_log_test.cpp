/// Logs of vehicles whose steering linkage is curved or not symmetric, or whose steering trim moves
/// the wheels beyond the stop.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

const Truth& kTruth = kTruths[1];

/// Steering stop of robot(), rad.
double stop_rad() { return radians(robot().steering_max_deg); }

/// Log of a vehicle whose wheels point to the angle `angle_at`(c) at the steering command c. The
/// commands reach the stop. Forces are equal left and right, so the motion hardly shows the scale
/// of the angles.
DrivingLog drive_with_linkage(const std::function<double(double)>& angle_at,
                              double duration_s = 15.0) {
  constexpr double kAmplification = 1.6;
  DrivingLog log =
      drive(kTruth, 8, {.duration_s = duration_s, .rate_hz = 50.0}, kMostPreciseSensors);
  for (double& command_rad : *log.steering_command_rad) {
    command_rad = std::clamp(kAmplification * command_rad, -stop_rad(), stop_rad());
  }
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.force_left[i] = log.force_right[i] = 0.5 * (log.force_left[i] + log.force_right[i]);
  }
  DrivingLog wheels = log;
  std::ranges::transform(*log.steering_command_rad, wheels.steering_command_rad->begin(), angle_at);
  Plant<double> without_stop = plant(kTruth);
  without_stop.steering_max_rad = 1.0;
  const std::pair<LogChannel, double> noise[] = {{LogChannel::kX, 0.014},
                                                 {LogChannel::kY, 0.014},
                                                 {LogChannel::kHeading, 0.0061},
                                                 {LogChannel::kSpeed, 0.007},
                                                 {LogChannel::kYawRate, 0.0031}};
  Random random(3, 4);
  replay<double>(LogSignals(wheels), 0, log.rows(), without_stop, nullptr, kSimulationStep_s, {},
                 [&](std::size_t row, const State<double>& state) {
                   for (const auto& [channel, std] : noise) {
                     if (!log[channel]) continue;
                     log[channel]->value[row] = channel_of(state, channel) + std * random.normal();
                   }
                 });
  return log;
}

Identification fit_of(DrivingLog log) {
  TrialData data;
  data.logs = {std::move(log)};
  auto result = identify(robot(), data, power_law(), {});
  EXPECT_TRUE(result);
  return result ? *std::move(result) : Identification{};
}

/// Expects that the parameters of the vehicle except the yaw resistance are within 4.5 standard
/// errors, with intervals.
void expect_mass_and_inertia(const Identification& result) {
  expect_recovered(result, ParameterId::kMassNorm, kTruth.mass_norm, 4.5);
  expect_recovered(result, ParameterId::kSurgeAlpha, kTruth.a1, 4.5);
  expect_recovered(result, ParameterId::kSurgeBeta, kTruth.b1, 4.5);
  expect_recovered(result, ParameterId::kInertiaNorm, 0.16 * kTruth.mass_norm, 4.5);
}

void expect_vehicle(const Identification& result) {
  expect_mass_and_inertia(result);
  expect_recovered(result, ParameterId::kYawAlpha, kTruth.a3, 4.5);
  expect_recovered(result, ParameterId::kYawBeta, kTruth.b3, 4.5);
}

/// Expects a yaw resistance near the truth, but without intervals.
void expect_yaw_without_intervals(const Identification& result, double tolerance) {
  for (const auto& [id, truth] : {std::pair(ParameterId::kYawAlpha, kTruth.a3),
                                  std::pair(ParameterId::kYawBeta, kTruth.b3)}) {
    EXPECT_NEAR(result.model[id].value.value_or(0.0), truth, tolerance * truth) << info(id).name;
    EXPECT_FALSE(result.model[id].ci95) << info(id).name;
  }
}

void expect_term(const Identification& result, const std::string& name, double value) {
  const auto found = estimated(result, name);
  ASSERT_TRUE(found && found->std_error) << name;
  EXPECT_NEAR(found->value, value, 4.5 * *found->std_error) << name;
}

/// c (1 + k (c/d_max)^2)
double curved(double command_rad, double k) {
  return command_rad * (1.0 + k * std::pow(command_rad / stop_rad(), 2));
}

TEST(SteeringLog, FindsACurvedLinkage) {
  constexpr double kCurve = 0.2;
  const Identification result =
      fit_of(drive_with_linkage([](double c) { return curved(c, kCurve); }, 30.0));
  EXPECT_TRUE(has_finding(result, "steering-curve"));
  EXPECT_FALSE(has_finding(result, "steering-dead-band"));
  EXPECT_FALSE(has_finding(result, "model-inadequate"));
  expect_term(result, "steering.curve", kCurve);
  expect_mass_and_inertia(result);
  expect_yaw_without_intervals(result, 0.05);
}

/// The angle is right at the stop, and too small at small commands. The fit defines the angles as
/// right at small commands, so the intervals have to include the scale.
TEST(SteeringLog, IncludesTheScaleOfACurvedLinkageInTheIntervals) {
  const Identification result =
      fit_of(drive_with_linkage([](double c) { return curved(0.85 * c, 0.15 / 0.85); }));
  EXPECT_TRUE(has_finding(result, "steering-curve"));
  EXPECT_FALSE(has_finding(result, "model-inadequate"));
  expect_mass_and_inertia(result);
  expect_yaw_without_intervals(result, 0.2);
}

/// The angles are right to the right, so their mean is not right.
TEST(SteeringLog, IncludesTheScaleOfAnAsymmetryInTheIntervals) {
  const Identification result =
      fit_of(drive_with_linkage([](double c) { return c > 0.0 ? 1.1 * c : c; }, 21.0));
  EXPECT_TRUE(has_finding(result, "steering-asymmetry"));
  expect_term(result, "steering.asymmetry", 0.05 / 1.05);
  expect_vehicle(result);
}

constexpr double kTrim_rad = 0.035;

TEST(SteeringLog, FindsATrimThatMovesTheWheelsBeyondTheStop) {
  const Identification result = fit_of(drive_with_linkage([](double c) { return c + kTrim_rad; }));
  EXPECT_TRUE(has_finding(result, "steering-trim"));
  EXPECT_FALSE(has_finding(result, "steering-dead-band"));
  expect_term(result, "steering.trim_rad", kTrim_rad);
  expect_vehicle(result);
}

TEST(SteeringLog, FindsATrimWithWheelsThatEndAtTheStop) {
  const Identification result =
      fit_of(drive_with_linkage([](double c) { return std::min(c + kTrim_rad, stop_rad()); }));
  EXPECT_TRUE(has_finding(result, "steering-trim"));
  EXPECT_FALSE(has_finding(result, "steering-dead-band"));
  expect_term(result, "steering.trim_rad", kTrim_rad);
  expect_vehicle(result);
}

}  // namespace
}  // namespace awmr::testing
