/// Logs of vehicles whose motors lag, and checks of a fit's results.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/identify/logs/problem/initial_guess.h"
#include "awmr/trials/replay.h"
#include "identify/synthetic_log.h"

namespace awmr::testing {

/// Expects that the estimate differs from the truth by at most `deviations` of its own standard
/// errors.
inline void expect_recovered(const Identification& result, ParameterId id, double truth,
                             double deviations) {
  const Estimate& estimate = result.model[id];
  ASSERT_TRUE(estimate.value && estimate.std_error) << info(id).name;
  EXPECT_NEAR(*estimate.value, truth, deviations * *estimate.std_error) << info(id).name;
}

/// Options in which these parameters are free, with initial guesses from the log only.
inline LogFitOptions guessed_from(const std::vector<DrivingLog>& logs,
                                  std::vector<ParameterId> free) {
  LogFitOptions options;
  options.vehicle = robot();
  options.initial_guess = guess_from_logs(logs, options.vehicle);
  options.free = std::move(free);
  options.guessed = options.free;
  return options;
}

/// Options for the power law in surge and yaw, for tests that do not test the choice of the family.
inline IdentifyOptions power_law() {
  IdentifyOptions options;
  options.surge_family = options.yaw_family = {.family = Family::kPower, .requested = true};
  return options;
}

/// power_law() in instances `Short` of a parameterised test; all families in the others.
inline IdentifyOptions options_of_instance() {
  const std::string_view suite =
      ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name();
  return suite.starts_with("Short/") ? power_law() : IdentifyOptions{};
}

/// Fits with the power law in instances `Short`, and with a choice of the families in `Long`.
class FitOfInstance : public ::testing::TestWithParam<bool> {
 protected:
  static IdentifyOptions options() { return GetParam() ? IdentifyOptions{} : power_law(); }
};

/// Force of motors with the time constant T = lag_s, averaged from each row to the next. The
/// command c is constant between rows: F'(t + h) = c + (F'(t) - c) exp(-h/T). `force`: F' at the
/// first row.
inline std::vector<double> behind_motors(const DrivingLog& log, const std::vector<double>& command,
                                         double lag_s, double force) {
  std::vector<double> mean = command;
  for (std::size_t i = 0; i + 1 < log.rows(); ++i) {
    const double h = log.t_s[i + 1] - log.t_s[i];
    const double e = std::exp(-h / lag_s);
    mean[i] = command[i] + (force - command[i]) * lag_s / h * (1.0 - e);
    force = command[i] + (force - command[i]) * e;
  }
  return mean;
}

/// Longest step of the simulated logs, s.
inline constexpr double kSimulationStep_s = 0.002;

/// Returns the log with the measurements of a vehicle whose motors have a lag with the time
/// constant `lag_s`. Before the log begins, the motors have the force of its first row, or no force
/// if `from_rest`. A `vehicle` with Coulomb friction must be a result of resolved_beside_friction()
/// for steps of kSimulationStep_s.
inline DrivingLog measured_behind_lag(DrivingLog log, const Plant<double>& vehicle, double lag_s,
                                      std::uint64_t seed, bool from_rest) {
  const std::map<LogChannel, double> noise{{LogChannel::kX, 0.014},
                                           {LogChannel::kY, 0.014},
                                           {LogChannel::kHeading, 0.007},
                                           {LogChannel::kSpeed, 0.007},
                                           {LogChannel::kYawRate, 0.007}};
  const std::vector<double> left = log.force_left;
  const std::vector<double> right = log.force_right;
  log.force_left = behind_motors(log, left, lag_s, from_rest ? 0.0 : left.front());
  log.force_right = behind_motors(log, right, lag_s, from_rest ? 0.0 : right.front());
  Random random(seed, 77);
  replay<double>(LogSignals(log), 0, log.rows(), vehicle, nullptr, kSimulationStep_s, {},
                 [&](std::size_t row, const State<double>& state) {
                   for (const auto& [channel, std] : noise) {
                     if (!log[channel]) continue;
                     log[channel]->value[row] = channel_of(state, channel) + std * random.normal();
                   }
                 });
  log.force_left = left;
  log.force_right = right;
  return log;
}

/// measured_behind_lag() of the log of drive().
inline DrivingLog drive_with_lag(const Truth& t, std::uint64_t seed, double lag_s,
                                 DrivePlan plan = {.duration_s = 10.0}, bool from_rest = false) {
  return measured_behind_lag(drive(t, seed, plan), plant(t), lag_s, seed, from_rest);
}

inline std::optional<EstimatorParameter> estimated(const Identification& result,
                                                   const std::string& name) {
  for (const EstimatorParameter& p : result.model.record.reports.back().parameters) {
    if (p.name == name) return p;
  }
  return std::nullopt;
}

/// Expects a value within 4.5 standard errors of `truth`.
inline void expect_estimated(const Identification& result, const std::string& name, double truth) {
  const auto found = estimated(result, name);
  ASSERT_TRUE(found && found->std_error) << name;
  EXPECT_NEAR(found->value, truth, 4.5 * *found->std_error) << name;
}

inline bool has_finding(const Identification& result, const std::string& code,
                        const std::string& words = "") {
  return std::ranges::any_of(result.model.record.findings, [&](const Finding& f) {
    return f.code == code && f.message.find(words) != std::string::npos;
  });
}

/// Leaves out all readings of the channel but every n-th.
inline void keep_every(std::size_t n, Measured& channel) {
  for (std::size_t row = 0; row < channel.fresh.size(); ++row) channel.fresh[row] = row % n == 0;
  channel.fresh_count = static_cast<int>(std::ranges::count(channel.fresh, true));
}

/// Reading of a channel in a row of the fast log.
using Reading = std::function<double(LogChannel, std::size_t)>;

/// Every `every`-th row of the fast log: its commands, and these readings of the channels.
inline DrivingLog thinned(const DrivingLog& fast, std::size_t every,
                          const std::vector<LogChannel>& channels, const Reading& reading) {
  DrivingLog log;
  log.file = "thinned.csv";
  log.steering_command_rad.emplace();
  for (const LogChannel channel : channels) log[channel].emplace();
  for (std::size_t i = 0; i < fast.rows(); i += every) {
    log.t_s.push_back(fast.t_s[i]);
    log.line.push_back(static_cast<int>(log.t_s.size()) + 1);
    log.force_left.push_back(fast.force_left[i]);
    log.force_right.push_back(fast.force_right[i]);
    log.steering_command_rad->push_back((*fast.steering_command_rad)[i]);
    for (const LogChannel channel : channels) {
      log[channel]->value.push_back(reading(channel, i));
      log[channel]->fresh.push_back(true);
      ++log[channel]->fresh_count;
    }
  }
  return log;
}

}  // namespace awmr::testing
