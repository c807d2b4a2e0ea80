/// Logs of vehicles with forces that the model does not contain: slope and Stribeck friction.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/logs/linear_replay.h"
#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

/// The motion of the vehicle by the commands of the log, with these forces.
std::vector<State<double>> motion_with(const DrivingLog& log, const Plant<double>& plant,
                                       const ExtraForces& extra) {
  constexpr double kStepOfMotion_s = 0.001;
  LinearStepper stepper(plant, 0, {}, {}, 0.0, extra);
  std::vector<State<double>> states;
  replay_linear(LogSignals(log), 0, log.rows(), {}, stepper, kStepOfMotion_s, {},
                [&](std::size_t, const LinearMotion& now) { states.push_back(now.state); });
  return states;
}

/// A drive of the plant with sensor noise and these forces.
DrivingLog drive_with(const Plant<double>& plant, const ExtraForces& extra) {
  Random random(8, 5);
  DrivingLog log = simulate_log(plant, robot(), {.duration_s = 25.0, .drive = 8}, {}, random);
  const std::vector<State<double>> before = motion_with(log, plant, {});
  const std::vector<State<double>> after = motion_with(log, plant, extra);
  for (const LogChannel channel : kChannels) {
    for (std::size_t row = 0; log[channel] && row < log.rows(); ++row) {
      log[channel]->value[row] +=
          channel_of(after[row], channel) - channel_of(before[row], channel);
    }
  }
  return log;
}

Identification identified(DrivingLog log, const IdentifyOptions& options = {}) {
  TrialData data;
  data.logs = {std::move(log)};
  return *identify(robot(), data, options, {});
}

void expect_estimated(const Identification& result, const std::string& name, double truth) {
  const auto found = estimated(result, name);
  ASSERT_TRUE(found && found->std_error) << name;
  EXPECT_NEAR(found->value, truth, 4.5 * *found->std_error) << name;
}

TEST(ForceLog, FindsASlope) {
  const Truth& t = kTruths[1];
  ExtraForces slope;
  slope[ExtraForce::kSlopeX] = 0.1;
  slope[ExtraForce::kSlopeY] = -0.15;
  const Identification result = identified(drive_with(plant(t), slope));
  EXPECT_TRUE(has_finding(result, "slope"));
  EXPECT_FALSE(has_finding(result, "model-inadequate"));
  expect_estimated(result, "slope.x_mps2", 0.1);
  expect_estimated(result, "slope.y_mps2", -0.15);
  expect_recovered(result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(result, ParameterId::kSurgeAlpha, t.a1, 4.5);
  expect_recovered(result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

TEST(ForceLog, FindsStribeckFriction) {
  Plant<double> robot_plant = plant(kTruths[1]);
  robot_plant.surge = {.alpha = 0.6, .beta = 1.0, .coulomb = 0.2};
  ExtraForces stribeck;
  stribeck[ExtraForce::kSurgeStribeck] = 0.15;
  stribeck[ExtraForce::kSurgeStribeckSpeed] = 0.2;
  IdentifyOptions options;
  options.yaw_family = {.family = Family::kPower, .requested = true};
  const Identification result = identified(drive_with(robot_plant, stribeck), options);
  EXPECT_TRUE(has_finding(result, "stribeck-friction"));
  EXPECT_FALSE(has_finding(result, "model-inadequate"));
  expect_recovered(result, ParameterId::kMassNorm, robot_plant.mass_norm, 4.5);
  // The form of the friction is unknown, so its resistance has no intervals.
  EXPECT_FALSE(result.model[ParameterId::kSurgeCoulomb].ci95);
  EXPECT_NEAR(result.model[ParameterId::kSurgeCoulomb].value.value_or(0.0), 0.2, 0.01);
  EXPECT_NEAR(result.model[ParameterId::kSurgeAlpha].value.value_or(0.0), 0.6, 0.02);
  expect_recovered(result, ParameterId::kInertiaNorm, robot_plant.inertia_norm, 4.5);
}

}  // namespace
}  // namespace awmr::testing
