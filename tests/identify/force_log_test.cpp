/// Logs of vehicles with forces that the model does not contain (extra_forces.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/logs/linear_replay.h"
#include "awmr/model/log_term_names.h"
#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

/// States of the vehicle under the commands of the log and these forces.
std::vector<State<double>> motion_with(const DrivingLog& log, const Plant<double>& plant,
                                       const ExtraForces& extra) {
  constexpr double kStepOfMotion_s = 0.001;
  LinearStepper stepper(plant, 0, {}, {}, 0.0, extra);
  std::vector<State<double>> states;
  replay_linear(LogSignals(log), 0, log.rows(), {}, stepper, kStepOfMotion_s, {},
                [&](std::size_t, const LinearMotion& now) { states.push_back(now.state); });
  return states;
}

/// Changes the readings of the log by the difference of these motions.
void move_readings(const std::vector<State<double>>& before,
                   const std::vector<State<double>>& after, DrivingLog& log) {
  for (const LogChannel channel : kChannels) {
    for (std::size_t row = 0; log[channel] && row < log.rows(); ++row) {
      log[channel]->value[row] +=
          channel_of(after[row], channel) - channel_of(before[row], channel);
    }
  }
}

/// Log of a drive of the plant with sensor noise and the extra forces. `reverses`: after the first
/// 5 s, the commanded wheel forces are reversed in every second interval of 3 s.
DrivingLog drive_with(const Plant<double>& plant, ExtraForces extra, bool reverses = false,
                      double rate_hz = 100.0, const SensorNoise& noise = {},
                      double duration_s = 25.0) {
  Random random(8, 5);
  DrivingLog log = simulate_log(
      plant, robot(), {.duration_s = duration_s, .rate_hz = rate_hz, .drive = 8}, noise, random);
  const std::vector<State<double>> before = motion_with(log, plant, {});
  for (std::size_t row = 0; reverses && row < log.rows(); ++row) {
    if (log.t_s[row] < 5.0 || static_cast<int>(log.t_s[row] / 3.0) % 2 == 0) continue;
    log.force_left[row] *= -0.6;
    log.force_right[row] *= -0.6;
  }
  extra.has_motor_per_side = has_force_difference(log);
  move_readings(before, motion_with(log, plant, extra), log);
  return log;
}

Identification identified(DrivingLog log, const IdentifyOptions& options = {}) {
  TrialData data;
  data.logs = {std::move(log)};
  return *identify(robot(), data, options, {});
}

TEST(ForceLog, FindsASlope) {
  const Truth& t = kTruths[1];
  ExtraForces slope;
  slope[ExtraForce::kSlopeX] = 0.1;
  slope[ExtraForce::kSlopeY] = -0.15;
  const Identification result =
      identified(drive_with(plant(t), slope, false, 50.0, kPreciseSensors, 16.0));
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

/// The forces of one test and their only finding.
struct ForceCase {
  std::string name;
  double truth;
  std::string code;
  ExtraForces forces;
};

class FoundForce : public ::testing::TestWithParam<ForceCase> {};

TEST_P(FoundForce, IsEstimatedBesideTheParameters) {
  const auto& [name, truth, code, forces] = GetParam();
  const Truth& t = kTruths[1];
  const Identification result =
      identified(drive_with(plant(t), forces, true, 50.0, kPreciseSensors, 16.0), power_law());
  EXPECT_TRUE(has_finding(result, code));
  EXPECT_FALSE(has_finding(result, "model-inadequate"));
  expect_estimated(result, name, truth);
  expect_recovered(result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(result, ParameterId::kSurgeAlpha, t.a1, 4.5);
  expect_recovered(result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

ForceCase force_case(ExtraForce force, double value, const std::string& code) {
  ForceCase one{std::string(kExtraForceNames[at(force)]), value, code, {}};
  one.forces[force] = value;
  return one;
}

INSTANTIATE_TEST_SUITE_P(
    All, FoundForce,
    ::testing::Values(force_case(ExtraForce::kTurnDrag, 0.3, "turn-drag"),
                      force_case(ExtraForce::kBrakeForce, 0.4, "brake-force"),
                      force_case(ExtraForce::kReverseForce, -0.3, "reverse-force"),
                      force_case(ExtraForce::kBackwardDrag, 0.5, "backward-drag"),
                      force_case(ExtraForce::kSidePull, 0.004, "side-pull"),
                      force_case(ExtraForce::kAxleOffset, 0.03, "axle-offset")),
    [](const auto& one) {
      std::string name = one.param.code;
      std::erase(name, '-');
      return name;
    });

/// The commands c of both sides lower the voltage of the battery: the forces are
/// c (1 - k (|c_left| + |c_right|)). At such a loss the intervals are withdrawn.
TEST(ForceLog, FindsTheSagOfACommonSupply) {
  constexpr double kSag = 0.08;  // k
  const Truth& t = kTruths[1];
  DrivingLog log = drive_with(plant(t), {}, true, 50.0, kPreciseSensors, 16.0);
  const std::vector<State<double>> before = motion_with(log, plant(t), {});
  double largest = 0.0;
  std::vector<SideForces<double>> commands;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const double share = static_cast<int>(log.t_s[row] / 2.0) % 2 == 0 ? 0.6 : -0.4;
    double& left = log.force_left[row];
    double& right = log.force_right[row];
    left *= 1.0 - share;
    right *= 1.0 + share;
    const double sum = std::abs(left) + std::abs(right);
    const double kept = 0.5 + std::sqrt(0.25 - kSag * sum);  // 1 - k (|c_left| + |c_right|)
    commands.push_back({left / kept, right / kept});
    largest = std::max({largest, std::abs(left / kept), std::abs(right / kept)});
  }
  move_readings(before, motion_with(log, plant(t), {}), log);
  for (std::size_t row = 0; row < log.rows(); ++row) {
    log.force_left[row] = commands[row].left;
    log.force_right[row] = commands[row].right;
  }
  const Identification result = identified(std::move(log), power_law());
  EXPECT_TRUE(has_finding(result, "force-saturation"));
  EXPECT_FALSE(has_finding(result, "model-inadequate"));
  const auto sag = estimated(result, "motor.supply_sag");
  ASSERT_TRUE(sag);
  EXPECT_NEAR(sag->value, 2.0 * kSag * largest, 0.01);
  for (const auto& [id, value] :
       {std::pair(ParameterId::kMassNorm, t.mass_norm), std::pair(ParameterId::kSurgeAlpha, t.a1),
        std::pair(ParameterId::kInertiaNorm, 0.16 * t.mass_norm)}) {
    EXPECT_NEAR(result.model[id].value.value_or(0.0), value, 0.02 * value) << info(id).name;
    EXPECT_FALSE(result.model[id].ci95) << info(id).name;
  }
}

/// A log of a differential vehicle with the resistances 0.6 u^0.9 and 0.075 r^0.8 (m' = 0.5 s^2/m,
/// I'z = 0.03 s^2 m, d = 0.2 m). A PI controller of each wheel follows the logged set-points, which
/// are fractions of 2 m/s.
DrivingLog log_of_set_points() {
  constexpr double kStepOfLoop_s = 0.001;
  constexpr double kHalfTrack_m = 0.2;
  constexpr int kStepsOfRow = 20;
  constexpr int kRows = 2000;
  constexpr int kRowsHeld = 100;
  Random random(3, 1);
  DrivingLog log;
  Measured speed;
  Measured yaw_rate;
  double u_mps = 0.0;
  double r_radps = 0.0;
  SideForces<double> wanted{};
  SideForces<double> sum{};
  for (int row = 0; row < kRows; ++row) {
    if (row % kRowsHeld == 0) {
      const double mean = 0.1 + 0.6 * random.uniform();
      const double turn = 0.2 * (random.uniform() - 0.5);
      wanted = {mean - turn, mean + turn};
    }
    log.t_s.push_back(row * kStepsOfRow * kStepOfLoop_s);
    log.line.push_back(row + 2);
    log.force_left.push_back(wanted.left);
    log.force_right.push_back(wanted.right);
    speed.value.push_back(u_mps + 0.01 * random.normal());
    yaw_rate.value.push_back(r_radps + 0.01 * random.normal());
    for (int step = 0; step < kStepsOfRow; ++step) {
      const double left = 2.0 * wanted.left - (u_mps - kHalfTrack_m * r_radps);
      const double right = 2.0 * wanted.right - (u_mps + kHalfTrack_m * r_radps);
      sum.left += left * kStepOfLoop_s;
      sum.right += right * kStepOfLoop_s;
      const SideForces<double> force{1.5 * left + 3.0 * sum.left, 1.5 * right + 3.0 * sum.right};
      const double surge = 0.6 * std::copysign(std::pow(std::abs(u_mps), 0.9), u_mps);
      const double yaw = 0.075 * std::copysign(std::pow(std::abs(r_radps), 0.8), r_radps);
      u_mps += kStepOfLoop_s * (2.0 * (force.left + force.right) - surge) / 0.5;
      r_radps += kStepOfLoop_s * (2.0 * kHalfTrack_m * (force.right - force.left) - yaw) / 0.03;
    }
  }
  log.file = "set_points.csv";
  log.steering_command_rad = std::vector<double>(log.rows(), 0.0);
  for (Measured* const channel : {&speed, &yaw_rate}) {
    channel->fresh.assign(log.rows(), true);
    channel->fresh_count = kRows;
  }
  log[LogChannel::kSpeed] = std::move(speed);
  log[LogChannel::kYawRate] = std::move(yaw_rate);
  return log;
}

TEST(ForceLog, NamesSetPointsOfASpeedController) {
  Vehicle vehicle = robot();
  vehicle.drive = Drive::kDifferential;
  vehicle.half_track_m = 0.2;
  TrialData data;
  data.logs = {log_of_set_points()};
  const auto result = identify(vehicle, data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "speed-controlled", "2 m/s"));
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].ci95);
}

/// Log of a differential robot (m' = 0.5 s^2/m, I'z = 0.03 s^2 m, g1 = 0.6 u^0.9, g3 = 0.075 r^0.8,
/// half track 0.2 m) whose motors have the dead zones 0.05 (left) and 0.09 (right).
DrivingLog log_of_unequal_dead_zones() {
  constexpr int kRows = 2000;
  constexpr int kStepsOfRow = 20;
  constexpr double kEulerStep_s = 0.001;
  constexpr double kHalfTrack_m = 0.2;
  Random random(3, 7);
  DrivingLog log;
  Measured speed;
  Measured yaw_rate;
  SideForces<double> command{0.0, 0.0};
  double u_mps = 0.0;
  double r_radps = 0.0;
  const auto beyond = [](double f, double zone) {
    return std::abs(f) > zone ? f - std::copysign(zone, f) : 0.0;
  };
  const auto power = [](double a, double v, double b) {
    return a * std::copysign(std::pow(std::abs(v), b), v);
  };
  for (int row = 0; row < kRows; ++row) {
    if (row % 35 == 0) {
      const double mean = 0.5 * random.uniform() - 0.1;
      const double half = 0.3 * (random.uniform() - 0.5);
      command = {mean - half, mean + half};
    }
    log.t_s.push_back(row * kStepsOfRow * kEulerStep_s);
    log.line.push_back(row + 2);
    log.force_left.push_back(command.left);
    log.force_right.push_back(command.right);
    speed.value.push_back(u_mps + 0.005 * random.normal());
    yaw_rate.value.push_back(r_radps + 0.005 * random.normal());
    const double left = beyond(command.left, 0.05);
    const double right = beyond(command.right, 0.09);
    for (int step = 0; step < kStepsOfRow; ++step) {
      u_mps += kEulerStep_s * (2.0 * (left + right) - power(0.6, u_mps, 0.9)) / 0.5;
      r_radps +=
          kEulerStep_s * (2.0 * kHalfTrack_m * (right - left) - power(0.075, r_radps, 0.8)) / 0.03;
    }
  }
  log.file = "dead_zones.csv";
  log.steering_command_rad = std::vector<double>(log.rows(), 0.0);
  for (Measured* const channel : {&speed, &yaw_rate}) {
    channel->fresh.assign(log.rows(), true);
    channel->fresh_count = kRows;
  }
  log[LogChannel::kSpeed] = std::move(speed);
  log[LogChannel::kYawRate] = std::move(yaw_rate);
  return log;
}

TEST(ForceLog, FindsUnequalDeadZonesOfTheMotors) {
  Vehicle vehicle = robot();
  vehicle.drive = Drive::kDifferential;
  vehicle.half_track_m = 0.2;
  TrialData data;
  data.logs = {log_of_unequal_dead_zones()};
  const auto result = identify(vehicle, data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "unequal-dead-zones"));
  EXPECT_FALSE(has_finding(*result, "force-imbalance"));
  expect_estimated(*result, "motor.dead_zone_difference", 0.02);
  expect_recovered(*result, ParameterId::kWheelDeadZone, 0.07, 4.0);
  expect_recovered(*result, ParameterId::kMassNorm, 0.5, 4.0);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.03, 4.0);
  expect_recovered(*result, ParameterId::kYawAlpha, 0.075, 4.0);
}

}  // namespace
}  // namespace awmr::testing
