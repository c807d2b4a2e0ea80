/// Logs of vehicles with forces that the model does not contain (extra_forces.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/logs/findings/term_findings.h"
#include "awmr/identify/logs/simulation/linear_replay.h"
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
                      double duration_s = 12.5) {
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
      identified(drive_with(plant(t), slope, false, 50.0, kVeryPreciseSensors, 8.0));
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
  const Identification result =
      identified(drive_with(robot_plant, stribeck, false, 100.0, kPreciseSensors), options);
  EXPECT_TRUE(has_finding(result, "stribeck-friction"));
  EXPECT_FALSE(has_finding(result, "model-inadequate"));
  expect_recovered(result, ParameterId::kMassNorm, robot_plant.mass_norm, 4.5);
  // The form of the friction is unknown, so its resistance has no intervals.
  EXPECT_FALSE(result.model[ParameterId::kSurgeCoulomb].ci95);
  EXPECT_NEAR(result.model[ParameterId::kSurgeCoulomb].value.value_or(0.0), 0.2, 0.01);
  EXPECT_NEAR(result.model[ParameterId::kSurgeAlpha].value.value_or(0.0), 0.6, 0.02);
  expect_recovered(result, ParameterId::kInertiaNorm, robot_plant.inertia_norm, 4.5);
}

TEST(ForceLog, DoesNotReportDifferencesOfLessThanHalfAPercent) {
  for (const ExtraForce force :
       {ExtraForce::kBrakeForce, ExtraForce::kReverseForce, ExtraForce::kBackwardDrag}) {
    LogFit fit;
    fit.quantities = {extra_force(force)};
    fit.refusal_reason = {""};
    fit.covariance = Eigen::MatrixXd::Constant(1, 1, 1e-10);
    for (const double excess : {0.0049, -0.0002, 0.0}) {
      fit.coordinates = {excess};
      EXPECT_TRUE(force_findings(fit, "log.csv").empty()) << excess;
    }
    fit.coordinates = {-0.006};
    EXPECT_EQ(force_findings(fit, "log.csv").size(), 1U);
  }
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
      identified(drive_with(plant(t), forces, true, 50.0, kVeryPreciseSensors, 8.0), power_law());
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
  DrivingLog log = drive_with(plant(t), {}, true, 50.0, kVeryPreciseSensors, 8.0);
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

/// Differential robot with the resistances 0.6 u^0.9 and 0.075 r^0.8 (m' = 0.5 s^2/m, I'z = 0.03
/// s^2 m, d = 0.2 m).
struct DifferentialRobot {
  static constexpr double kHalfTrack_m = 0.2;
  static constexpr double kLoop_s = 0.001;
  double u_mps = 0.0;
  double r_radps = 0.0;

  /// Moves for kLoop_s with the force of one of the two wheels on each side (Euler's method).
  void move(const SideForces<double>& force) {
    const double surge = 0.6 * std::copysign(std::pow(std::abs(u_mps), 0.9), u_mps);
    const double yaw = 0.075 * std::copysign(std::pow(std::abs(r_radps), 0.8), r_radps);
    u_mps += kLoop_s * (2.0 * (force.left + force.right) - surge) / 0.5;
    r_radps += kLoop_s * (2.0 * kHalfTrack_m * (force.right - force.left) - yaw) / 0.03;
  }
};

using Commands = std::function<SideForces<double>(Random&)>;
using WheelForce =
    std::function<SideForces<double>(const SideForces<double>& command, const DifferentialRobot&)>;

/// Log of the robot of 40 s at 50 Hz. The command changes every `rows_held` rows; the measurements
/// have noise of the standard deviation `noise_std` (m/s, rad/s).
DrivingLog differential_log(Random random, int rows_held, double noise_std,
                            const Commands& next_command, const WheelForce& force_of) {
  constexpr int kStepsOfRow = 20;
  constexpr int kRows = 2000;
  DrivingLog log;
  Measured speed;
  Measured yaw_rate;
  DifferentialRobot robot;
  SideForces<double> command{};
  for (int row = 0; row < kRows; ++row) {
    if (row % rows_held == 0) command = next_command(random);
    log.t_s.push_back(row * kStepsOfRow * DifferentialRobot::kLoop_s);
    log.line.push_back(row + 2);
    log.force_left.push_back(command.left);
    log.force_right.push_back(command.right);
    speed.value.push_back(robot.u_mps + noise_std * random.normal());
    yaw_rate.value.push_back(robot.r_radps + noise_std * random.normal());
    for (int step = 0; step < kStepsOfRow; ++step) robot.move(force_of(command, robot));
  }
  log.file = "differential.csv";
  log.steering_command_rad = std::vector<double>(log.rows(), 0.0);
  for (Measured* const channel : {&speed, &yaw_rate}) {
    channel->fresh.assign(log.rows(), true);
    channel->fresh_count = kRows;
  }
  log[LogChannel::kSpeed] = std::move(speed);
  log[LogChannel::kYawRate] = std::move(yaw_rate);
  return log;
}

/// The vehicle file of the robot.
Vehicle differential_robot() {
  Vehicle vehicle = robot();
  vehicle.drive = Drive::kDifferential;
  vehicle.half_track_m = DifferentialRobot::kHalfTrack_m;
  return vehicle;
}

/// A PI controller of each wheel follows the logged set-points, which are fractions of 2 m/s.
DrivingLog log_of_set_points() {
  const auto set_point = [](Random& random) {
    const double mean = 0.1 + 0.6 * random.uniform();
    const double turn = 0.2 * (random.uniform() - 0.5);
    return SideForces<double>{mean - turn, mean + turn};
  };
  SideForces<double> sum{};
  const auto controlled = [&sum](const SideForces<double>& wanted, const DifferentialRobot& at) {
    const double turn_mps = DifferentialRobot::kHalfTrack_m * at.r_radps;
    const double left = 2.0 * wanted.left - (at.u_mps - turn_mps);
    const double right = 2.0 * wanted.right - (at.u_mps + turn_mps);
    sum.left += left * DifferentialRobot::kLoop_s;
    sum.right += right * DifferentialRobot::kLoop_s;
    return SideForces<double>{1.5 * left + 3.0 * sum.left, 1.5 * right + 3.0 * sum.right};
  };
  return differential_log(Random(3, 1), 100, 0.01, set_point, controlled);
}

TEST(ForceLog, NamesSetPointsOfASpeedController) {
  TrialData data;
  data.logs = {log_of_set_points()};
  const auto result = identify(differential_robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "speed-controlled", "2 m/s"));
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].ci95);
}

/// The motors have the dead zones 0.05 (left) and 0.09 (right).
DrivingLog log_of_unequal_dead_zones() {
  const auto command = [](Random& random) {
    const double mean = 0.5 * random.uniform() - 0.1;
    const double half = 0.3 * (random.uniform() - 0.5);
    return SideForces<double>{mean - half, mean + half};
  };
  const auto beyond = [](double force, double zone) {
    return std::abs(force) > zone ? force - std::copysign(zone, force) : 0.0;
  };
  return differential_log(
      Random(3, 7), 35, 0.005, command,
      [&](const SideForces<double>& at, const DifferentialRobot&) {
        return SideForces<double>{beyond(at.left, 0.05), beyond(at.right, 0.09)};
      });
}

TEST(ForceLog, FindsUnequalDeadZonesOfTheMotors) {
  TrialData data;
  data.logs = {log_of_unequal_dead_zones()};
  const auto result = identify(differential_robot(), data, {}, {});
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
