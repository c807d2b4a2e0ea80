/// Fit of driving logs: known truth, subsets of channels, gaps, and non-identifiable parameters.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "awmr/identify/logs/problem/channel_noise.h"
#include "awmr/identify/logs/problem/identifiability.h"
#include "awmr/identify/logs/problem/whitener.h"
#include "awmr/identify/planning/recover.h"
#include "awmr/model/model_file.h"
#include "awmr/trials/log_start.h"
#include "awmr/trials/replay.h"
#include "identify/log_answers.h"
#include "support/scratch_file.h"

namespace awmr::testing {
namespace {

class Logs : public FitOfInstance {};
INSTANTIATE_TEST_SUITE_P(Short, Logs, ::testing::Values(false));
INSTANTIATE_TEST_SUITE_P(Long, Logs, ::testing::Values(true));

bool refused(const Identification& result, ParameterId id) {
  return std::find(result.refused.begin(), result.refused.end(), id) != result.refused.end();
}

/// Severity of the finding that the parameter is not identifiable; absent without such a finding.
std::optional<Severity> severity_of_refusal(const Identification& result, ParameterId id) {
  for (const Finding& finding : result.model.record.findings) {
    const std::string name = std::string(info(id).name) + " ";
    if (finding.code == "not-identifiable" && finding.message.starts_with(name)) {
      return finding.severity;
    }
  }
  return std::nullopt;
}

TEST(Log, IdentifiesEveryParameterFromALogAlone) {
  for (const Truth& t : kTruths) {
    TrialData data;
    data.logs = {drive(t, 3, {.duration_s = 20.0, .rate_hz = 50.0})};
    const auto result = identify(robot(), data, {}, {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->refused.empty());
    // For eight parameters and two true vehicles, 4.5 standard errors give a failure probability of
    // 1e-4.
    expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
    expect_recovered(*result, ParameterId::kSurgeBeta, t.b1, 4.5);
    expect_recovered(*result, ParameterId::kYawAlpha, t.a3, 4.5);
    expect_recovered(*result, ParameterId::kYawBeta, t.b3, 4.5);
    expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
    expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
    const auto& report = result->model.record.reports.back();
    EXPECT_EQ(report.estimator, Estimator::kTrajectory);
    EXPECT_GE(report.starts.size(), 7U);
    EXPECT_EQ(std::count_if(report.starts.begin(), report.starts.end(),
                            [](const SearchStart& s) { return s.chosen; }),
              1);
  }
}

TEST(Log, SpeedAloneShowsSurgeAndRefusesYaw) {
  TrialData data;
  data.logs = {drive(kTruths[1], 4, {.duration_s = 20.0, .straight = true})};
  for (const LogChannel c :
       {LogChannel::kX, LogChannel::kY, LogChannel::kHeading, LogChannel::kYawRate}) {
    data.logs[0][c].reset();
  }
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeBeta, kTruths[1].b1, 4.5);
  constexpr std::array kNotMeasured{ParameterId::kYawAlpha, ParameterId::kYawBeta,
                                    ParameterId::kInertiaNorm, ParameterId::kSwayAlpha};
  for (const ParameterId id : kNotMeasured) {
    EXPECT_FALSE(result->model[id].value) << info(id).name;
    EXPECT_EQ(severity_of_refusal(*result, id), Severity::kNote) << info(id).name;
  }
  // The servo lag of the vehicle file is kept and reported as not identifiable from the log.
  EXPECT_EQ(severity_of_refusal(*result, ParameterId::kSteeringTimeConstant), Severity::kNote);
  EXPECT_EQ(result->model[ParameterId::kSteeringTimeConstant].value, 0.02);
  EXPECT_TRUE(result->refused.empty());

  // Named parameters are refused.
  IdentifyOptions named;
  named.requested = {ParameterId::kSurgeAlpha, ParameterId::kYawAlpha, ParameterId::kSwayAlpha,
                     ParameterId::kSteeringTimeConstant};
  const auto refusal = identify(robot(), data, named, {});
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->refused, (std::vector{ParameterId::kYawAlpha, ParameterId::kSwayAlpha,
                                           ParameterId::kSteeringTimeConstant}));
  EXPECT_EQ(severity_of_refusal(*refusal, ParameterId::kSwayAlpha), Severity::kError);
}

TEST(Log, AtOneConstantThrustShowsOnlyACombinationOfAlphaAndBeta) {
  TrialData data;
  data.logs = {drive(kTruths[0], 5, {.duration_s = 10.0, .hold_s = 100.0, .straight = true})};
  DrivingLog& log = data.logs[0];
  // Removes the first rows, so that the log begins at a steady speed.
  const auto keep = [](std::vector<double>& v) { v.erase(v.begin(), v.begin() + 300); };
  log.line.erase(log.line.begin(), log.line.begin() + 300);
  keep(log.t_s);
  keep(log.force_left);
  keep(log.force_right);
  keep(*log.steering_command_rad);
  for (auto& measured : log.measured) {
    if (!measured) continue;
    keep(measured->value);
    measured->fresh.erase(measured->fresh.begin(), measured->fresh.begin() + 300);
  }
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(refused(*result, ParameterId::kSurgeBeta));
  EXPECT_TRUE(refused(*result, ParameterId::kMassNorm));
}

TEST(Log, IsIdentifiedWithGapsAndIrregularSamples) {
  const Truth& t = kTruths[1];
  DrivingLog full = drive(t, 6, {.duration_s = 30.0});
  DrivingLog log;
  log.file = full.file;
  log.steering_command_rad.emplace();
  Random random(1, 9);
  for (const LogChannel c : kChannels) {
    if (full[c]) log[c] = Measured{{}, {}, 0, full[c]->held};
  }
  for (std::size_t i = 0; i < full.rows(); ++i) {
    const bool gap = i > 1200 && i < 1600;
    // Drops a third of the rows at random, but none in which the command changes.
    const bool lost = i % 150 != 0 && random.uniform() < 0.33;
    if (gap || lost) continue;
    log.line.push_back(full.line[i]);
    log.t_s.push_back(full.t_s[i]);
    log.force_left.push_back(full.force_left[i]);
    log.force_right.push_back(full.force_right[i]);
    log.steering_command_rad->push_back((*full.steering_command_rad)[i]);
    for (const LogChannel c : kChannels) {
      if (!full[c]) continue;
      log[c]->value.push_back(full[c]->value[i]);
      log[c]->fresh.push_back(full[c]->fresh[i]);
      log[c]->fresh_count += full[c]->fresh[i] ? 1 : 0;
    }
  }
  TrialData data;
  data.logs = {log};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

TEST(Log, FindsADelayAndABias) {
  const Truth& t = kTruths[1];
  DrivingLog log = drive(t, 8, {.duration_s = 20.0, .rate_hz = 50.0});
  // The commands were logged three samples before they reached the wheels.
  const auto early = [](std::vector<double>& v) {
    std::rotate(v.begin(), v.begin() + 3, v.end());
    std::fill(v.end() - 3, v.end(), v[v.size() - 4]);
  };
  early(log.force_left);
  early(log.force_right);
  early(*log.steering_command_rad);
  for (double& r : log[LogChannel::kYawRate]->value) r += 0.05;
  TrialData data;
  data.logs = {log};
  IdentifyOptions options;
  options.terms = {"input_delay_s"};
  options.biases = {LogChannel::kYawRate};
  const auto result = identify(robot(), data, options, {});
  ASSERT_TRUE(result);
  const EstimatorReport& report = result->model.record.reports.back();
  const auto parameter = [&](const std::string& name) {
    for (const EstimatorParameter& p : report.parameters) {
      if (p.name == name) return p;
    }
    ADD_FAILURE() << name;
    return EstimatorParameter{};
  };
  EXPECT_NEAR(parameter("input_delay_s").value, 0.06, 4.5 * *parameter("input_delay_s").std_error);
  EXPECT_NEAR(parameter("bias.yaw_rate_radps").value, 0.05,
              4.5 * *parameter("bias.yaw_rate_radps").std_error);
  EXPECT_LT(*parameter("input_delay_s").std_error, 0.003);
}

TEST(Log, FindsTheBiasOfAGyroscopeWithoutAHeading) {
  constexpr double kBias_radps = 0.02;
  DrivingLog log = drive(kTruths[1], 8, {.duration_s = 15.0, .rate_hz = 50.0}, kPreciseSensors);
  remove_pose(log);
  for (double& r : log[LogChannel::kYawRate]->value) r += kBias_radps;
  TrialData data;
  data.logs = {log};
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "gyro-bias"));
  EXPECT_FALSE(has_finding(*result, "side-pull"));
  const auto& parameters = result->model.record.reports.back().parameters;
  const auto bias = std::ranges::find(parameters, "bias.yaw_rate_radps", &EstimatorParameter::name);
  ASSERT_TRUE(bias != parameters.end() && bias->std_error);
  EXPECT_NEAR(bias->value, kBias_radps, 4.5 * *bias->std_error);
  expect_recovered(*result, ParameterId::kYawAlpha, kTruths[1].a3, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
}

/// Shifts the commands of a log by this number of rows: to later rows if positive.
void move_commands(DrivingLog& log, int rows) {
  const auto move = [rows](std::vector<double>& v) {
    const std::vector<double> old = v;
    const int last = static_cast<int>(v.size()) - 1;
    for (int i = 0; i <= last; ++i) {
      v[static_cast<std::size_t>(i)] = old[static_cast<std::size_t>(std::clamp(i - rows, 0, last))];
    }
  };
  move(log.force_left);
  move(log.force_right);
  move(*log.steering_command_rad);
}

TEST(Log, FindsWhatDiffersBetweenLogs) {
  constexpr double kWeaker = 0.94;
  constexpr int kRowsLate = 4;
  constexpr double kBias_radps[] = {0.01, 0.03, -0.02};
  TrialData data;
  for (int i = 0; i < 3; ++i) {
    DrivingLog log =
        drive(kTruths[1], 8 + i, {.duration_s = 8.0, .rate_hz = 50.0}, kVeryPreciseSensors);
    log.number = i + 1;
    log.file = fmt::format("log_{}.csv", i + 1);
    remove_pose(log);
    for (double& r : log[LogChannel::kYawRate]->value) r += kBias_radps[i];
    if (log.number == 2) {
      for (double& force : log.force_left) force /= kWeaker;
      for (double& force : log.force_right) force /= kWeaker;
    }
    if (log.number == 3) move_commands(log, kRowsLate);
    data.logs.push_back(std::move(log));
  }
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "forces-differ"));
  EXPECT_TRUE(has_finding(*result, "delay-differs"));
  EXPECT_TRUE(has_finding(*result, "gyro-bias"));
  EXPECT_FALSE(has_finding(*result, "logs-disagree"));
  const auto& parameters = result->model.record.reports.back().parameters;
  for (const auto& [name, truth] :
       {std::pair("motor.force_scale.log_2", kWeaker - 1.0),
        std::pair("motor.force_scale.log_3", 0.0), std::pair("bias.yaw_rate_radps", kBias_radps[0]),
        std::pair("input_delay_s.log_2", 0.0), std::pair("input_delay_s.log_3", -0.02 * kRowsLate),
        std::pair("bias.yaw_rate_radps.log_2", kBias_radps[1] - kBias_radps[0]),
        std::pair("bias.yaw_rate_radps.log_3", kBias_radps[2] - kBias_radps[0])}) {
    const auto found = std::ranges::find(parameters, name, &EstimatorParameter::name);
    ASSERT_TRUE(found != parameters.end() && found->std_error) << name;
    EXPECT_NEAR(found->value, truth, 4.5 * *found->std_error) << name;
  }
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kYawAlpha, kTruths[1].a3, 4.5);
  const ScratchFile file("differs.model.json", "");
  ASSERT_TRUE(write_model(result->model, file.path()));
  EXPECT_TRUE(read_model(file.path()));
}

TEST_P(Logs, FindsALatencyOfCommandsAndOfTheirTimeStamps) {
  constexpr double kStep_s = 0.02;
  for (const int rows : {-2, 3}) {
    TrialData data;
    data.logs = {
        drive(kTruths[1], 8, {.duration_s = 4.0, .rate_hz = 1.0 / kStep_s}, kPreciseSensors)};
    move_commands(data.logs[0], rows);
    const auto result = identify(robot(), data, options(), {});
    ASSERT_TRUE(result);
    const auto delay = estimated(*result, "input_delay_s");
    ASSERT_TRUE(delay && delay->std_error) << rows;
    EXPECT_NEAR(delay->value, -kStep_s * rows, 4.5 * *delay->std_error);
    EXPECT_TRUE(has_finding(*result, rows > 0 ? "late-commands" : "actuator-lag"));
    expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
    expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
  }
}

TEST_P(Logs, FreesMotorLagAndDeadTimeTogether) {
  constexpr double kLag_s = 0.08;
  TrialData data;
  data.logs = {drive_with_lag(kTruths[1], 8, kLag_s, {.duration_s = 6.0, .rate_hz = 50.0})};
  move_commands(data.logs[0], -2);
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  const auto lag = estimated(*result, "motor.time_constant_s");
  const auto delay = estimated(*result, "input_delay_s");
  ASSERT_TRUE(lag && lag->std_error && delay && delay->std_error);
  EXPECT_NEAR(lag->value, kLag_s, 4.5 * *lag->std_error);
  EXPECT_NEAR(delay->value, 0.04, 4.5 * *delay->std_error);
  EXPECT_TRUE(has_finding(*result, "actuator-lag", "in addition to the motors' lag"));
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
}

TEST_P(Logs, SeparatesMotorLagFromADeadTime) {
  constexpr double kLag_s = 0.08;
  TrialData data;
  data.logs = {drive_with_lag(kTruths[1], 8, kLag_s, {.duration_s = 6.0, .rate_hz = 50.0})};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  const auto lag = estimated(*result, "motor.time_constant_s");
  ASSERT_TRUE(lag && lag->std_error);
  EXPECT_NEAR(lag->value, kLag_s, 4.5 * *lag->std_error);
  EXPECT_TRUE(has_finding(*result, "actuator-lag"));
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeAlpha, kTruths[1].a1, 4.5);
}

/// The motors are switched on at the first row. The lag makes speed and yaw rate look filtered.
class LargeMotorLag : public ::testing::TestWithParam<double> {};

TEST_P(LargeMotorLag, IsFoundInALogThatBeginsWithTheMotors) {
  const double lag_s = GetParam();
  TrialData data;
  data.logs = {drive_with_lag(kTruths[1], 8, lag_s, {.duration_s = 6.0, .rate_hz = 50.0}, true)};
  add_row_of_rest(data.logs[0]);
  ASSERT_EQ(data.logs[0].force_left[0], 0.0);
  const auto result = identify(robot(), data, options_of_instance(), {});
  ASSERT_TRUE(result);
  const auto lag = estimated(*result, "motor.time_constant_s");
  ASSERT_TRUE(lag && lag->std_error);
  EXPECT_NEAR(lag->value, lag_s, 4.5 * *lag->std_error);
  EXPECT_FALSE(has_finding(*result, "sensor-lag"));
  EXPECT_FALSE(has_finding(*result, "stribeck-friction"));
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
}
INSTANTIATE_TEST_SUITE_P(Short, LargeMotorLag, ::testing::Values(0.3));
INSTANTIATE_TEST_SUITE_P(Long, LargeMotorLag, ::testing::Values(0.3));

TEST(Log, RefusesAnImpossibleInertia) {
  TrialData data;
  data.logs = {drive(kTruths[1], 3, {.duration_s = 20.0, .rate_hz = 50.0})};
  Vehicle small = robot();
  small.length_m = 0.4;
  small.width_m = 0.24;
  const auto result = identify(small, data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(refused(*result, ParameterId::kInertiaNorm));
  EXPECT_FALSE(result->model[ParameterId::kInertiaNorm].value);
  EXPECT_TRUE(result->model[ParameterId::kMassNorm].value);
}

TEST(Log, DoesNotDependOnTheNumberOfThreads) {
  TrialData data;
  data.logs = {drive(kTruths[0], 11, {.duration_s = 8.0, .rate_hz = 50.0})};
  IdentifyOptions one;
  one.threads = 1;
  IdentifyOptions three;
  three.threads = 3;
  EXPECT_EQ(model_text(identify(robot(), data, one, {})->model),
            model_text(identify(robot(), data, three, {})->model));
}

TEST(Log, ReportsAContradictionWithTables) {
  const Truth& t = kTruths[0];
  TrialData data = synthetic(t, 0.01, 3);
  data.coastdown.reset();
  data.logs = {
      drive({t.a1 * 1.3, t.b1, t.a3, t.b3, t.mass_norm}, 3, {.duration_s = 20.0, .rate_hz = 50.0})};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  const bool has_finding_of_it =
      std::any_of(result->model.record.findings.begin(), result->model.record.findings.end(),
                  [](const Finding& f) {
                    return f.code == "estimates-disagree" && f.message.starts_with("surge.alpha");
                  });
  EXPECT_TRUE(has_finding_of_it);
}

TEST(Log, CorrelatedErrorsAreFoundAndWidenTheIntervals) {
  const Truth& t = kTruths[1];
  Random white(1, 5);
  Random autocorrelated(1, 5);
  const DrivePlan plan{.duration_s = 12.0, .rate_hz = 50.0, .drive = 2};
  TrialData data;
  data.logs = {simulate_log(plant(t), robot(), plan, {}, white)};
  const auto plain = identify(robot(), data, {}, {});
  data.logs = {simulate_log(plant(t), robot(), plan, {.correlation_s = 0.1}, autocorrelated)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(plain && result);
  EXPECT_THAT(result->model.record.reports.back().noise, ::testing::HasSubstr("correlated over"));
  EXPECT_GT(*result->model[ParameterId::kSurgeAlpha].std_error,
            2.0 * *plain->model[ParameterId::kSurgeAlpha].std_error);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
}

TEST_P(Logs, FindsAndCompensatesALatencyOfTheSpeed) {
  const Truth& t = kTruths[0];
  constexpr std::size_t kLate = 5;  // rows of 20 ms
  TrialData data;
  data.logs = {drive(t, 21, {.duration_s = 8.4, .rate_hz = 50.0}, kVeryPreciseSensors)};
  std::vector<double>& speed = data.logs[0][LogChannel::kSpeed]->value;
  std::rotate(speed.rbegin(), speed.rbegin() + kLate, speed.rend());
  std::fill(speed.begin(), speed.begin() + kLate, speed[kLate]);
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "sensor-delay", "speed_mps"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  for (const EstimatorParameter& p : result->model.record.reports.back().parameters) {
    if (p.name == "delay.speed_mps") {
      EXPECT_NEAR(p.value, 0.1, 4.5 * *p.std_error);
    }
  }
}

/// Returns the log with its commands moved to `rows` rows earlier: they reach the motors later than
/// logged.
DrivingLog commanded_early(DrivingLog log, std::size_t rows) {
  const auto earlier = [rows](std::vector<double>& values) {
    std::rotate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows), values.end());
  };
  earlier(log.force_left);
  earlier(log.force_right);
  earlier(*log.steering_command_rad);
  return log;
}

TEST_P(Logs, ReportsTheActuatorsIfAllSensorsAreDelayed) {
  const DrivingLog log =
      drive(kTruths[0], 22, {.duration_s = 6.0, .rate_hz = 50.0}, kVeryPreciseSensors);
  TrialData data;
  data.logs = {commanded_early(log, 3)};
  const auto result = identify(robot(), data, options(), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "actuator-lag"));
  const auto delay = estimated(*result, "input_delay_s");
  ASSERT_TRUE(delay && delay->std_error);
  EXPECT_NEAR(delay->value, 0.06, 4.5 * *delay->std_error);
  IdentifyOptions with_delay = power_law();
  with_delay.terms = {"input_delay_s"};
  const auto delayed = identify(robot(), data, with_delay, {});
  ASSERT_TRUE(delayed);
  EXPECT_TRUE(has_finding(*delayed, "actuator-lag", "s after its commands"));
  data.logs = {log};
  EXPECT_FALSE(has_finding(*identify(robot(), data, options(), {}), "actuator-lag", ""));
}

/// Expects that the logs do not identify the servo lag, which is an error only if it is named.
void expect_servo_lag_refused_only_if_named(const TrialData& data) {
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(refused(*result, ParameterId::kSteeringTimeConstant));
  EXPECT_EQ(severity_of_refusal(*result, ParameterId::kSteeringTimeConstant), Severity::kNote);
  IdentifyOptions named = power_law();
  named.requested = {ParameterId::kSteeringTimeConstant};
  const auto refusal = identify(robot(), data, named, {});
  ASSERT_TRUE(refusal);
  EXPECT_TRUE(refused(*refusal, ParameterId::kSteeringTimeConstant));
  EXPECT_EQ(severity_of_refusal(*refusal, ParameterId::kSteeringTimeConstant), Severity::kError);
}

TEST(Log, RefusesTheServoLagWithoutASteeringCommand) {
  TrialData data;
  data.logs = {drive(kTruths[1], 23, {.duration_s = 8.0})};
  std::ranges::fill(*data.logs[0].steering_command_rad, 0.0);
  expect_servo_lag_refused_only_if_named(data);
}

TEST(Log, RefusesTheServoLagIfOnlyTheSpeedIsMeasured) {
  TrialData data;
  data.logs = {drive(kTruths[1], 23, {.duration_s = 8.0})};
  for (const LogChannel channel :
       {LogChannel::kX, LogChannel::kY, LogChannel::kHeading, LogChannel::kYawRate,
        LogChannel::kSway, LogChannel::kSteering}) {
    data.logs[0][channel].reset();
  }
  expect_servo_lag_refused_only_if_named(data);
}

TEST(Log, OfSkidTurnsWithASteeringColumnShowsTheInertia) {
  const Truth& t = kTruths[1];
  const std::map<LogChannel, double> noise{{LogChannel::kX, 0.02},
                                           {LogChannel::kY, 0.02},
                                           {LogChannel::kHeading, 0.002},
                                           {LogChannel::kSpeed, 0.01},
                                           {LogChannel::kYawRate, 0.001}};
  DrivingLog log = drive(t, 8, {.duration_s = 40.0, .rate_hz = 50.0});
  std::ranges::fill(*log.steering_command_rad, 0.0);
  Random random(8, 77);
  replay<double>(LogSignals(log), 0, log.rows(), plant(t), nullptr, 0.002, {},
                 [&](std::size_t row, const State<double>& state) {
                   for (const auto& [channel, std] : noise) {
                     log[channel]->value[row] = channel_of(state, channel) + std * random.normal();
                   }
                 });
  TrialData data;
  data.logs = {std::move(log)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "not-identifiable", "steering.time_constant_s"));
  EXPECT_FALSE(estimated(*result, "steering.time_constant_s"));
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
}

TEST(Log, AServoTooFastForALogIsNamed) {
  TrialData data;
  data.logs = {drive(kTruths[0], 3)};
  Vehicle fast = robot();
  fast.steering_time_constant_s = 1e-5;
  const auto result = identify(fast, data, {}, {});
  ASSERT_FALSE(result);
  EXPECT_THAT(to_text(result.error()),
              ::testing::HasSubstr("steering.time_constant_s is 1e-05 s, too fast"));
}

TEST(Log, AFitAtItsTimeLimitReportsNoWrongValue) {
  TrialData data;
  const Truth& t = kTruths[0];
  data.logs = {drive(t, 3, {.duration_s = 4.0})};
  for (const double limit_s : {1e-6, 0.02, 0.1, 0.3}) {
    const auto result = identify(robot(), data, {.time_limit_s = limit_s}, {});
    ASSERT_TRUE(result);
    const Estimate& mass = result->model[ParameterId::kMassNorm];
    if (mass.value) expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.0);
    EXPECT_EQ(mass.value.has_value(), !refused(*result, ParameterId::kMassNorm));
  }
}

TEST(Log, SelectsAndReportsABetterFamily) {
  const Truth& t = kTruths[0];
  Plant<double> braked = plant(t);
  braked.surge = {.alpha = 0.74, .beta = 1.0, .coulomb = 0.15};
  Random random(22, 5);
  TrialData data;
  data.logs = {simulate_log(braked, robot(), {.duration_s = 20.0, .rate_hz = 50.0, .drive = 22},
                            kPreciseSensors, random)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(terms_of(result->model.surge_family).coulomb);
  EXPECT_TRUE(has_finding(*result, "power-law-inadequate", "AIC"));
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kSurgeCoulomb, 0.15, 4.5);
}

constexpr double kBackEmf = 0.2;

/// Log of a drive with motors that have back-EMF.
DrivingLog geared_drive(const Truth& t, std::uint64_t seed, double duration_s = 20.0) {
  Plant<double> geared = plant(t);
  geared.back_emf_s_per_m = kBackEmf;
  Random random(seed, 5);
  return simulate_log(geared, robot(), {.duration_s = duration_s, .rate_hz = 50.0, .drive = seed},
                      kPreciseSensors, random);
}

class BackEmfOfSeeds : public ::testing::TestWithParam<int> {};

/// Test parameter: number of seeds.
TEST_P(BackEmfOfSeeds, IsRecoveredFromDrivingAndCoastingAndReported) {
  const Truth& t = kTruths[0];
  int covered = 0;
  for (int seed = 1; seed <= GetParam(); ++seed) {
    TrialData data;
    data.logs = {geared_drive(t, 100 + static_cast<std::uint64_t>(seed))};
    const auto result = identify(robot(), data, options_of_instance(), {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(has_finding(*result, "back-emf", "AIC")) << seed;
    // For three parameters and three seeds, 4.5 standard errors give a failure probability of 6e-5.
    expect_recovered(*result, ParameterId::kBackEmf, kBackEmf, 4.5);
    expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
    expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
    const auto& ci95 = result->model[ParameterId::kBackEmf].ci95;
    ASSERT_TRUE(ci95);
    covered += ci95->contains(kBackEmf) ? 1 : 0;
  }
  // An interval misses the truth with a probability of 5 %, all three with 0.05^3 = 1.3e-4.
  if (GetParam() == 3) {
    EXPECT_GE(covered, 1);
  }
}
INSTANTIATE_TEST_SUITE_P(Short, BackEmfOfSeeds, ::testing::Values(1));
/// With three seeds, also a check of the interval's coverage.
INSTANTIATE_TEST_SUITE_P(Long, BackEmfOfSeeds, ::testing::Values(3));

TEST(BackEmf, IsFoundInLogsFromDifferentGround) {
  constexpr double kHigher = 1.2;
  // Its drag is smaller than the difference between the grounds, which hides it at first.
  constexpr double kSmallBackEmf = 0.04;
  Plant<double> geared = plant(kTruths[0]);
  geared.back_emf_s_per_m = kSmallBackEmf;
  geared.surge = {.alpha = 1.0, .beta = 1.0, .coulomb = 0.12};
  TrialData data;
  for (int number = 1; number <= 2; ++number) {
    Random random(static_cast<std::uint64_t>(number), 5);
    const DrivePlan plan{.duration_s = 16.0, .rate_hz = 25.0, .drive = 70U + number};
    data.logs.push_back(simulate_log(geared, robot(), plan, kMostPreciseSensors, random));
    data.logs.back().number = number;
    remove_pose(data.logs.back());
    for (Resistance<double>* one : {&geared.surge, &geared.yaw}) {
      one->alpha *= kHigher;
      one->coulomb *= kHigher;
    }
  }
  IdentifyOptions options;
  options.yaw_family = {.family = Family::kPower, .requested = true};
  const auto result = identify(robot(), data, options, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "back-emf"));
  EXPECT_TRUE(has_finding(*result, "resistance-differs"));
  EXPECT_FALSE(has_finding(*result, "model-inadequate"));
  expect_recovered(*result, ParameterId::kBackEmf, kSmallBackEmf, 4.5);
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[0].mass_norm, 4.5);
}

TEST(BackEmf, IsNotFoundForIdealMotorsAndRefusedOnRequest) {
  TrialData data;
  data.logs = {drive(kTruths[0], 31, {.duration_s = 20.0, .rate_hz = 50.0}, kPreciseSensors)};
  const auto by_itself = identify(robot(), data, {}, {});
  ASSERT_TRUE(by_itself);
  EXPECT_FALSE(has_finding(*by_itself, "back-emf", ""));
  EXPECT_EQ(by_itself->model[ParameterId::kBackEmf].value, 0.0);
  const auto requested = identify(robot(), data, {.requested = {ParameterId::kBackEmf}}, {});
  ASSERT_TRUE(requested);
  const Estimate& estimate = requested->model[ParameterId::kBackEmf];
  ASSERT_TRUE(estimate.value && estimate.std_error);
  EXPECT_NEAR(*estimate.value, 0.0, 4.5 * *estimate.std_error);
}

TEST(BackEmf, WithoutCoastingIsRefusedWithTheTrialThatShowsIt) {
  TrialData data;
  data.logs = {geared_drive(kTruths[0], 41, 4.0)};
  DrivingLog& log = data.logs[0];
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (log.force_left[row] == 0.0) log.force_left[row] = log.force_right[row] = 1e-3;
  }
  const auto requested = identify(robot(), data, {.requested = {ParameterId::kBackEmf}}, {});
  ASSERT_TRUE(requested);
  EXPECT_TRUE(refused(*requested, ParameterId::kBackEmf));
  EXPECT_EQ(requested->model[ParameterId::kBackEmf].value, 0.0);
  EXPECT_TRUE(has_finding(*requested, "not-identifiable", "coasting with the motors off"));
}

TEST(BackEmf, OfTheDataSheetIsFixedAndExcludesTables) {
  Vehicle geared = robot();
  geared.back_emf_s_per_m = kBackEmf;
  TrialData data;
  data.logs = {geared_drive(kTruths[0], 51)};
  const auto result = identify(geared, data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->model[ParameterId::kBackEmf].value, kBackEmf);
  EXPECT_EQ(result->model[ParameterId::kBackEmf].source, Source::kGiven);
  expect_recovered(*result, ParameterId::kSurgeAlpha, kTruths[0].a1, 4.5);
  const auto tables = identify(geared, synthetic(kTruths[0], 0.02, 1), {}, {});
  ASSERT_FALSE(tables);
  EXPECT_THAT(to_text(tables.error()), ::testing::HasSubstr("identify this vehicle from logs"));
}

TEST(FrontWheelDrive, GivesEveryParameterOfALog) {
  const Truth& t = kTruths[0];
  Vehicle vehicle = robot();
  vehicle.drive = Drive::kFrontWheel;
  Plant<double> pulled = plant(t);
  pulled.rear_driven = 0.0;
  Random random(61, 5);
  TrialData data;
  data.logs = {simulate_log(pulled, vehicle, {.duration_s = 20.0, .rate_hz = 50.0, .drive = 61}, {},
                            random)};
  const auto result = identify(vehicle, data, {}, {});
  ASSERT_TRUE(result);
  expect_recovered(*result, ParameterId::kSurgeAlpha, t.a1, 4.5);
  expect_recovered(*result, ParameterId::kYawAlpha, t.a3, 4.5);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * t.mass_norm, 4.5);
}

/// Logs of one robot whose position sensors have this noise, m.
std::vector<DrivingLog> logs_with_positions(std::initializer_list<double> noise_m) {
  std::vector<DrivingLog> logs;
  for (const double one_m : noise_m) {
    SensorNoise noise = kPreciseSensors;
    noise.position_m = one_m;
    const int number = static_cast<int>(logs.size()) + 1;
    logs.push_back(drive(kTruths[1], 40 + number, {.duration_s = 15.0, .rate_hz = 50.0}, noise));
    logs.back().number = number;
  }
  return logs;
}

TEST(Log, EstimatesTheNoiseOfEachLogIfTheSensorsDiffer) {
  constexpr double kGps_m = 0.3;
  constexpr double kMotionCapture_m = 0.002;
  const std::vector<DrivingLog> logs = logs_with_positions({kGps_m, kMotionCapture_m});
  TrialData data;
  data.logs = logs;
  const auto result = identify(robot(), data, power_law(), {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(has_finding(*result, "coloured-residuals"));
  EXPECT_FALSE(has_finding(*result, "model-inadequate"));
  EXPECT_THAT(result->model.record.reports.back().noise, ::testing::HasSubstr("x_m in log 2"));
  expect_recovered(*result, ParameterId::kMassNorm, kTruths[1].mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm, 4.5);
  const NoiseLevels levels = sensor_noise(fit_windows(logs, kWindow_s));
  // The standard error of the noise of 750 readings is 4 %.
  EXPECT_NEAR(levels.at({LogChannel::kX, 1}).white_std, kGps_m, 0.16 * kGps_m);
  EXPECT_LT(levels.at({LogChannel::kX, 2}).white_std, 0.1 * kGps_m);
  EXPECT_TRUE(levels.contains({LogChannel::kSpeed}));
}

// The sensors are precise, so the first quick fit is far from the log. Windows shorter than the time
// between two positions would fit every position exactly.
TEST(Log, PositionsOncePerSecondBesideAPreciseHeading) {
  constexpr SensorNoise kNoise{
      .speed_mps = 0.0007, .yaw_rate_radps = 0.0015, .heading_rad = 0.00006, .position_m = 0.017};
  Plant<double> car = plant(kTruths[0]);
  car.surge = {.alpha = 0.38, .beta = 2.0};
  car.yaw = {.alpha = 0.1, .beta = 0.96};
  car.mass_norm = 0.84;
  car.inertia_norm = 0.058;
  Random random(1, 5);
  const DrivePlan plan{.duration_s = 20.0, .rate_hz = 50.0, .drive = 74};
  TrialData data;
  data.logs = {simulate_log(car, robot(), plan, kNoise, random)};
  for (const LogChannel c : {LogChannel::kX, LogChannel::kY}) keep_every(50, *data.logs.front()[c]);
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(has_finding(*result, "model-inadequate"));
  expect_recovered(*result, ParameterId::kMassNorm, car.mass_norm, 4.5);
  expect_recovered(*result, ParameterId::kInertiaNorm, car.inertia_norm, 4.5);
}

TEST(Log, EqualSensorsOfSeveralLogsHaveOneNoiseModel) {
  const std::vector<DrivingLog> logs = logs_with_positions({0.05, 0.05, 0.05});
  for (const auto& [sensor, noise] : sensor_noise(fit_windows(logs, kWindow_s))) {
    EXPECT_EQ(sensor.log, 0) << describe(sensor);
  }
}

TEST(Log, ReportsAnotherMassOnTheSecondDayAndWidensTheInterval) {
  Truth heavy = kTruths[0];
  heavy.mass_norm *= 1.2;
  TrialData data;
  data.logs = {drive(kTruths[0], 23, {.duration_s = 12.0, .rate_hz = 50.0}, kPreciseSensors),
               drive(heavy, 24, {.duration_s = 12.0, .rate_hz = 50.0}, kPreciseSensors)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "logs-disagree", "mass_norm"));
  const Estimate& mass = result->model[ParameterId::kMassNorm];
  ASSERT_TRUE(mass.ci95);
  EXPECT_LT(mass.ci95->lo, kTruths[0].mass_norm);
  EXPECT_GT(mass.ci95->hi, heavy.mass_norm);
  const Estimate& inertia = result->model[ParameterId::kInertiaNorm];
  ASSERT_TRUE(inertia.ci95);
  EXPECT_LT(inertia.ci95->lo, 0.16 * kTruths[0].mass_norm);
  EXPECT_GT(inertia.ci95->hi, 0.16 * heavy.mass_norm);
}

TEST(Log, ReportsADifferenceBetweenLogsBeforeAModelError) {
  Truth heavy = kTruths[0];
  heavy.mass_norm *= 2.0;
  TrialData data;
  data.logs = {drive(kTruths[0], 23, {.duration_s = 12.0, .rate_hz = 50.0}, kPreciseSensors),
               drive(heavy, 24, {.duration_s = 12.0, .rate_hz = 50.0}, kPreciseSensors)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  const std::vector<Finding>& findings = result->model.record.findings;
  const auto place = [&](std::string_view code) {
    return std::ranges::find(findings, code, &Finding::code) - findings.begin();
  };
  EXPECT_LT(place("logs-disagree"), place("model-inadequate"));
  EXPECT_LT(place("model-inadequate"), std::ssize(findings));
}

TEST(Log, LogsOfOneVehicleAgree) {
  TrialData data;
  for (const std::uint64_t seed : {25U, 26U}) {
    data.logs.push_back(
        drive(kTruths[0], seed, {.duration_s = 20.0, .rate_hz = 50.0}, kPreciseSensors));
  }
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(has_finding(*result, "logs-disagree", ""));
  EXPECT_FALSE(has_finding(*result, "sensor-delay", ""));
  EXPECT_FALSE(has_finding(*result, "power-law-inadequate", ""));
}

/// The model identified from a log in whose last fifth a1 is multiplied by `factor`.
Identification identified_with_change(double factor, std::uint64_t seed) {
  Truth changed = kTruths[0];
  changed.a1 *= factor;
  TrialData data;
  data.logs = {log_with_change(kTruths[0], changed, 48.0, 12.0, seed)};
  return identify(robot(), data, options_of_instance(), {}).value();
}

TEST(Log, WithdrawsTheIntervalsIfTheInertiaShowsAWrongUnitOfTheSpeed) {
  DrivingLog log = drive(kTruths[0], 25, {.duration_s = 12.0, .rate_hz = 50.0});
  // The speed is in rad/s of wheels of 0.1 m, 10 times the value in m/s. The estimated I'z/m' is
  // then 0.82 * 10 times that of the box, more than the largest possible 3.
  for (double& u : log[LogChannel::kSpeed]->value) u *= 10.0;
  for (const LogChannel c : {LogChannel::kX, LogChannel::kY}) log[c].reset();
  TrialData data;
  data.logs = {log};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(has_finding(*result, "inertia-mismatch", "rate of rotation"));
  EXPECT_FALSE(result->model[ParameterId::kInertiaNorm].value);
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].ci95);
  EXPECT_FALSE(result->model[ParameterId::kSurgeAlpha].ci95);
}

/// Test parameter: seed of the drive.
class HeldOut : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(HeldOut, AChangeInTheLastFifthIsReportedAndItsIntervalWithdrawnOrWidened) {
  constexpr double kFactor = 1.02;
  const Identification result = identified_with_change(kFactor, GetParam());
  // A clear change gives a model error, so that its time is searched. The comparison of both halves
  // may report it too, and then the interval contains the values before and after the change.
  EXPECT_TRUE(has_finding(result, "held-out-misses", "surge.alpha") ||
              has_finding(result, "changed-in-log", "surge.alpha") ||
              has_finding(result, "logs-disagree", "surge.alpha"));
  const auto& interval = result.model[ParameterId::kSurgeAlpha].ci95;
  if (!interval) return;
  EXPECT_LT(interval->lo, kTruths[0].a1);
  EXPECT_GT(interval->hi, kFactor * kTruths[0].a1);
}

// The significance level is 0.001, so the probability of a false finding in any of the five drives
// is 1 in 200.
TEST_P(HeldOut, ADriveWithoutAChangeIsPredicted) {
  const Identification result = identified_with_change(1.0, GetParam());
  EXPECT_FALSE(has_finding(result, "held-out-misses", ""));
  EXPECT_TRUE(result.model[ParameterId::kSurgeAlpha].ci95);
}

INSTANTIATE_TEST_SUITE_P(Short, HeldOut, ::testing::Values(31U));
/// More seeds, for a rough check of the rates of false alarms and misses.
INSTANTIATE_TEST_SUITE_P(Long, HeldOut, ::testing::Values(32U, 33U, 34U, 35U));

TEST(Log, SeparatesDriftFromWhiteNoise) {
  ChannelNoise truth{.white_std = 0.02, .drift_std = 0.03, .correlation_s = 0.5};
  Random random(7, 3);
  std::vector<ErrorSeries> series(10);
  for (ErrorSeries& part : series) {
    double drift = truth.drift_std * random.normal();
    for (int k = 0; k < 1000; ++k) {
      const double phi = std::exp(-0.01 / truth.correlation_s);
      if (k > 0)
        drift = phi * drift + truth.drift_std * std::sqrt(1.0 - phi * phi) * random.normal();
      part.error.push_back(drift + truth.white_std * random.normal());
      part.since_s.push_back(k == 0 ? 0.0 : 0.01);
    }
  }
  const ChannelNoise found = likeliest_noise(series, 1.0, {});
  // Tolerance: the series is 200 correlation times long, which determines level and correlation
  // time of the drift to about a tenth.
  EXPECT_NEAR(found.white_std, truth.white_std, 0.05 * truth.white_std);
  EXPECT_NEAR(found.drift_std, truth.drift_std, 0.3 * truth.drift_std);
  EXPECT_NEAR(std::log(found.correlation_s / truth.correlation_s), 0.0, 0.6);
}

TEST(Log, RecognisesDifferencedNoise) {
  constexpr double kStd = 0.02;
  for (const double theta : {0.4, 0.95, 1.0}) {
    Random random(8, 3);
    std::vector<ErrorSeries> series(10);
    for (ErrorSeries& part : series) {
      double before = kStd * random.normal();
      for (int k = 0; k < 1000; ++k) {
        const double now = kStd * random.normal();
        part.error.push_back(now - theta * before);
        part.since_s.push_back(k == 0 ? 0.0 : 0.01);
        before = now;
      }
    }
    const ChannelNoise found = likeliest_noise(series, 1.0, {});
    // 10,000 values determine theta to sqrt(1 - theta^2)/100.
    EXPECT_NEAR(found.differenced, theta, 0.04) << theta;
    EXPECT_NEAR(found.white_std, kStd, 0.05 * kStd) << theta;
    EXPECT_EQ(found.drift_std, 0.0) << theta;
  }
}

/// Scores (gradients of -ln L) of `logs` logs, with alternating signs. Their size is `times` the
/// standard deviation that `information` predicts.
Scores scattered(int logs, double times, double information) {
  Scores scores;
  const double size = times * std::sqrt(information / logs);
  for (int i = 0; i < logs; ++i) {
    scores.logs.push_back(Eigen::VectorXd::Constant(1, i % 2 == 0 ? size : -size));
  }
  return scores;
}

TEST(Log, WholeLogsThatScatterBeyondChanceWidenTheIntervals) {
  const double information = 1e4;
  const auto factor = [&](int logs, double times) {
    return identifiability(Eigen::MatrixXd::Constant(1, 1, information),
                           scattered(logs, times, information),
                           {free_parameter(ParameterId::kSurgeAlpha)})
        .factor.front();
  };
  // With m logs, V/C = m/(m - 1) times^2: the variance from the scatter of the logs (V) over the
  // variance that the noise model predicts (C). If only noise scatters six logs, V/C is below
  // chi^2_0.95/5 = 2.21 with a probability of 95 %. The prior changes the result by 4e-6.
  EXPECT_NEAR(factor(6, 3.0), std::sqrt(1.2) * 3.0, 1e-4);
  EXPECT_EQ(factor(6, 1.3), 1.0);
  EXPECT_EQ(factor(2, 5.0), 1.0) << "two logs are too few";
}

TEST(Log, ARefusedTermOfAResistanceRefusesTheRest) {
  LogProblem problem;
  problem.model.quantities = {
      free_parameter(ParameterId::kSurgeAlpha), free_parameter(ParameterId::kYawAlpha),
      free_parameter(ParameterId::kYawBeta), free_parameter(ParameterId::kYawCoulomb)};
  problem.bounds.assign(4, {-10.0, 10.0});
  Identifiability found;
  found.covariance = Eigen::MatrixXd::Identity(4, 4);
  found.refusal_reason = {"", "", "", "the search ended at the end of its range"};
  const Identifiability result = without_stopped(found, problem, {0.0, 0.0, 1.0, 0.1});
  EXPECT_EQ(result.refusal_reason[0], "");
  EXPECT_THAT(result.refusal_reason[1], ::testing::StartsWith("yaw.coulomb is not determined"));
  EXPECT_THAT(result.refusal_reason[2], ::testing::StartsWith("yaw.alpha is not determined"));
}

TEST(Log, AnInsignificantFrictionIsRefusedTogetherWithItsCoefficient) {
  constexpr double kError = 0.04;
  LogProblem problem;
  problem.model.quantities = {free_parameter(ParameterId::kYawAlpha),
                              free_parameter(ParameterId::kYawCoulomb)};
  problem.bounds.assign(2, {-10.0, 10.0});
  const FreeQuantity& friction = problem.model.quantities[1];
  const auto reason = [&](double value, const std::string& why_alpha) {
    const double x = to_coordinate(friction.scale, value);
    const double std = kError / friction.jacobian(x);
    Identifiability found;
    found.covariance = Eigen::Vector2d(1.0, std * std).asDiagonal();
    found.refusal_reason = {why_alpha, ""};
    return without_stopped(found, problem, {0.0, x}).refusal_reason[1];
  };
  EXPECT_THAT(reason(1.9 * kError, "unknown"),
              ::testing::StartsWith("yaw.alpha is not determined"));
  EXPECT_EQ(reason(2.1 * kError, "unknown"), "");
  EXPECT_EQ(reason(1.9 * kError, ""), "");
}

/// Oscillating errors, d'' = -2 zeta omega d' - omega^2 d + noise, integrated with small steps,
/// plus white noise. The oscillation has standard deviation 1.
std::vector<ErrorSeries> swinging(double omega, double zeta, double white_std, double step_s) {
  constexpr int kSteps = 50;
  const double h = step_s / kSteps;
  // Var d = q/(4 zeta omega^3) for noise of density q.
  const double push = std::sqrt(4.0 * zeta * omega * omega * omega * h);
  Random random(11, 4);
  std::vector<ErrorSeries> series(10);
  for (ErrorSeries& part : series) {
    double d = random.normal();
    double rate = omega * random.normal();
    for (int k = 0; k < 1000; ++k) {
      part.error.push_back(d + white_std * random.normal());
      part.since_s.push_back(k == 0 ? 0.0 : step_s);
      for (int i = 0; i < kSteps; ++i) {
        rate += h * (-2.0 * zeta * omega * rate - omega * omega * d) + push * random.normal();
        d += h * rate;
      }
    }
  }
  return series;
}

TEST(Log, DetectsAnOscillatingErrorAsSecondOrder) {
  for (const double zeta : {0.2, 0.5, 1.0, 2.0}) {
    for (const double white_std : {0.0, 0.3}) {
      SCOPED_TRACE(::testing::Message() << "zeta " << zeta << ", white " << white_std);
      const auto series = swinging(9.4, zeta, white_std, 0.01);
      const ChannelNoise found = likeliest_noise(series, 1.0, {});
      EXPECT_TRUE(found.second_order());
      // A hundred seconds contain about 150 oscillations, which determine the frequency to a few
      // per cent, and damping and level to a tenth. The bounds are three times that. They are
      // doubled for zeta > 1, because the slow time constant, 2 zeta/omega, hides the fast one.
      const double loose = zeta > 1.0 ? 2.0 : 1.0;
      EXPECT_NEAR(std::log(found.frequency_radps / 9.4), 0.0, 0.2 * loose);
      EXPECT_NEAR(std::log(found.damping / zeta), 0.0, 0.35 * loose);
      EXPECT_NEAR(std::log(found.drift_std), 0.0, 0.3);
      EXPECT_NEAR(found.white_std, white_std, 0.03);
    }
  }
}

TEST(Log, InnovationsOfASecondOrderErrorAreWhiteWithTheStatedVariance) {
  const ChannelNoise noise{
      .white_std = 0.1, .drift_std = 1.0, .frequency_radps = 9.4, .damping = 0.5};
  double squares = 0.0;
  double products = 0.0;
  double count = 0.0;
  for (const ErrorSeries& part : swinging(9.4, 0.5, 0.1, 0.01)) {
    Whitener whitener(noise);
    double before = 0.0;
    for (std::size_t k = 0; k < part.error.size(); ++k) {
      const auto [value, variance] = whitener.next(part.error[k], part.since_s[k]);
      const double z = value / std::sqrt(variance);
      squares += z * z;
      products += z * before;
      before = z;
      count += 1.0;
    }
  }
  // Tolerance: four standard errors of a mean square, and of a mean product, of 10,000 normal
  // numbers.
  EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count));
  EXPECT_NEAR(products / count, 0.0, 4.0 / std::sqrt(count));
}

TEST(Recover, GivesBiasAndCoverageOfTables) {
  const auto fitted = identify(robot(), synthetic(kTruths[0], 0.02, 1), {}, {});
  ASSERT_TRUE(fitted);
  Model model = fitted->model;
  model[ParameterId::kSwayAlpha].value = 3.0;
  RecoverOptions options;
  options.runs = 400;
  const auto recovery = recover(model, options, {});
  ASSERT_TRUE(recovery);
  EXPECT_EQ(recovery->failed, 0);
  for (const RecoveredParameter& p : recovery->parameters) {
    // The coverage of 400 intervals is 95 % with a standard deviation of 1.1 %; 4.5 of them are
    // allowed.
    EXPECT_NEAR(p.coverage95, 0.95, 0.05) << info(p.id).name;
    EXPECT_NEAR(p.bias, 0.0, 5.0 * p.rmse / std::sqrt(400.0) + 0.02 * p.truth) << info(p.id).name;
  }
  options.runs = 40;
  const auto in_parallel = recover(model, options, {});
  options.threads = 1;
  const auto alone = recover(model, options, {});
  EXPECT_EQ(recovery_text(*alone, {}), recovery_text(*in_parallel, {}));
}

}  // namespace
}  // namespace awmr::testing
