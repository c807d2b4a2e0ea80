/// Derivatives of a log fit's cost with respect to delays, lags and smoothing, compared with finite
/// differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/logs/choice/interpolated_commands.h"
#include "awmr/identify/logs/choice/log_terms.h"
#include "awmr/identify/logs/problem/log_problem.h"
#include "identify/synthetic_log.h"

namespace awmr {
namespace {

using testing::drive;
using testing::kTruths;
using testing::robot;
using testing::Truth;

double total_cost(const LogProblem& problem, const SearchPoint& point) {
  double cost = 0.0;
  for (const WindowSums& window : sums_at(problem, point)) cost += window.cost();
  return cost;
}

LogFitOptions options_with(const Truth& t, const std::vector<FreeTerm>& terms) {
  LogFitOptions options;
  options.vehicle = robot();
  ParameterValues<double>& guess = options.initial_guess;
  guess[at(ParameterId::kSurgeAlpha)] = t.a1;
  guess[at(ParameterId::kSurgeBeta)] = t.b1;
  guess[at(ParameterId::kYawAlpha)] = t.a3;
  guess[at(ParameterId::kYawBeta)] = t.b3;
  guess[at(ParameterId::kSwayAlpha)] = 10.0;
  guess[at(ParameterId::kMassNorm)] = 1.2 * t.mass_norm;
  guess[at(ParameterId::kInertiaNorm)] = 0.2 * t.mass_norm;
  guess[at(ParameterId::kSteeringTimeConstant)] = 0.1;
  options.free = {ParameterId::kMassNorm, ParameterId::kInertiaNorm};
  options.terms = terms;
  const auto is_run_on = [](const FreeTerm& term) {
    return term.quantity.is(FreeQuantity::Kind::kRunOn);
  };
  if (std::ranges::any_of(terms, is_run_on)) guess[at(ParameterId::kBackEmf)] = 0.2;
  return options;
}

struct TermCase {
  std::string name;
  std::vector<FreeTerm> terms;
};

/// Raw errors of one channel, without the other channels.
std::vector<double> errors_of_channel(const LogProblem& problem, LogChannel channel) {
  std::vector<double> errors;
  const std::vector<WindowErrors> windows =
      errors_at(problem, from_measured(problem, problem.initial));
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const std::vector<Sample>& samples = problem.windows[w].samples();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (samples[i].channel == channel) errors.push_back(windows[w].raw(eigen_index(i)));
    }
  }
  return errors;
}

// A smoothed reading depends on later rows, a delayed reading on earlier rows.
TEST(Residuals, SmoothingOfOneChannelLeavesTheOthersAsTheyAre) {
  const Truth& t = kTruths[1];
  const std::vector<DrivingLog> logs = {drive(t, 3, {.duration_s = 10.0})};
  const std::vector<FreeTerm> others = {
      {free_term(FreeQuantity::Kind::kSensorDelay, LogChannel::kX), 0.07},
      {sensor_lag_of(LogChannel::kHeading), 0.09}};
  std::vector<FreeTerm> all = others;
  all.push_back({smoothing_of(LogChannel::kSpeed), 0.002});
  const LogProblem without = log_problem(logs, options_with(t, others));
  const LogProblem with = log_problem(logs, options_with(t, all));
  for (const LogChannel channel : {LogChannel::kX, LogChannel::kHeading, LogChannel::kYawRate}) {
    EXPECT_EQ(errors_of_channel(with, channel), errors_of_channel(without, channel));
  }
  EXPECT_NE(errors_of_channel(with, LogChannel::kSpeed),
            errors_of_channel(without, LogChannel::kSpeed));
}

/// The log with its change of commands at `row` moved to a later time, by `later_s`.
DrivingLog with_later_change(DrivingLog log, std::size_t row, double later_s) {
  log.t_s[row] += later_s;
  return log;
}

/// Root of the sum of squares of the differences between two series.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares);
}

// Errors at the likeliest times of changes hardly depend on the time at which a change is assumed.
// Errors at known times do.
TEST(Residuals, AreThoseAtTheLikeliestTimesOfChanges) {
  constexpr double kLater_s = 0.003;
  const Truth& t = kTruths[1];
  DrivingLog log = with_changes_between_rows({drive(t, 3, {.duration_s = 10.0})}).front();
  for (double& std_s : log.change_std_s) std_s *= 10.0;
  std::size_t row = 0;  // of the last change of the force
  for (std::size_t i = 1; i < log.rows(); ++i) {
    if (log.force_left[i] != log.force_left[i - 1]) row = i;
  }
  DrivingLog known = log;
  known.change_std_s.clear();
  const auto change_by_time = [&](const DrivingLog& of) {
    const std::vector<DrivingLog> logs = {of};
    const std::vector<DrivingLog> moved = {with_later_change(of, row, kLater_s)};
    const LogProblem before = log_problem(logs, options_with(t, {}));
    const LogProblem after = log_problem(moved, options_with(t, {}));
    return difference(errors_of_channel(before, LogChannel::kSpeed),
                      errors_of_channel(after, LogChannel::kSpeed));
  };
  EXPECT_LT(change_by_time(log), 0.1 * change_by_time(known));
}

class TermDerivatives : public ::testing::TestWithParam<TermCase> {};

TEST_P(TermDerivatives, AgreeWithDifferencesOfTheCost) {
  constexpr double kStep = 1e-6;
  const Truth& t = kTruths[1];
  const DrivingLog steps = drive(t, 3, {.duration_s = 10.0});
  for (const bool is_interpolated : {false, true}) {
    std::vector<DrivingLog> logs = {steps};
    if (is_interpolated) logs = interpolated(logs);
    const LogProblem problem = log_problem(logs, options_with(t, GetParam().terms));
    const SearchPoint point = from_measured(problem, problem.initial);
    const std::vector<WindowSums> sums = sums_at(problem, point);
    for (std::size_t i = 0; i < point.coordinates.size(); ++i) {
      double gradient = 0.0;
      for (const WindowSums& window : sums) {
        gradient += window.products(eigen_index(i), window.products.cols() - 1);
      }
      SearchPoint more = point;
      SearchPoint less = point;
      more.coordinates[i] += kStep;
      less.coordinates[i] -= kStep;
      const double difference =
          (total_cost(problem, more) - total_cost(problem, less)) / (2.0 * kStep);
      // Tolerance: commands that change within an integration step make the cost function rough at
      // the scale of kStep.
      EXPECT_NEAR(gradient, difference, 0.02 * std::abs(difference) + 1.0)
          << problem.model.quantities[i].name() << " interpolated " << is_interpolated;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfEachKind, TermDerivatives,
    ::testing::Values(
        TermCase{"DelayAndLag",
                 {{free_term(FreeQuantity::Kind::kDelay), 0.031},
                  {free_term(FreeQuantity::Kind::kMotorLag), 0.047}}},
        TermCase{"SensorDelay",
                 {{free_term(FreeQuantity::Kind::kSensorDelay, LogChannel::kYawRate), 0.013}}},
        TermCase{"Averaging",
                 {{free_term(FreeQuantity::Kind::kAveraging, LogChannel::kSpeed), 0.053},
                  {free_term(FreeQuantity::Kind::kAveraging, LogChannel::kYawRate), 0.024}}},
        TermCase{"AveragingAndSensorDelay",
                 {{free_term(FreeQuantity::Kind::kSensorDelay, LogChannel::kSpeed), 0.013},
                  {free_term(FreeQuantity::Kind::kAveraging, LogChannel::kSpeed), 0.046}}},
        TermCase{"SensorLag", {{sensor_lag_of(LogChannel::kSpeed), 0.08}}},
        TermCase{"SecondOrderLag",
                 {{sensor_lag_of(LogChannel::kSpeed), 0.08},
                  {free_term(FreeQuantity::Kind::kLagDamping, LogChannel::kSpeed), 0.6}}},
        TermCase{"OverdampedLag",
                 {{sensor_lag_of(LogChannel::kYawRate), 0.06},
                  {free_term(FreeQuantity::Kind::kLagDamping, LogChannel::kYawRate), 1.3}}},
        TermCase{"TrackingFilter",
                 {{sensor_lag_of(LogChannel::kSpeed, true), 0.11},
                  {free_term(FreeQuantity::Kind::kLagDamping, LogChannel::kSpeed), 0.62}}},
        TermCase{"Ramps",
                 {{free_term(FreeQuantity::Kind::kForceRise), 0.7},
                  {free_term(FreeQuantity::Kind::kForceFall), 0.4}}},
        TermCase{"RampThatTurnsSlowly", {{force_rise(true), 0.8}}},
        TermCase{"RampWithDelayAndLag",
                 {{free_term(FreeQuantity::Kind::kDelay), 0.023},
                  {free_term(FreeQuantity::Kind::kMotorLag), 0.047},
                  {free_term(FreeQuantity::Kind::kForceRise), 0.8}}},
        TermCase{"GaussianSmoothing", {{smoothing_of(LogChannel::kSpeed), 0.0031}}},
        TermCase{"NarrowSmoothing", {{smoothing_of(LogChannel::kYawRate), 2e-6}}},
        TermCase{"MovingAverage", {{smoothing_of(LogChannel::kYawRate, true), 0.0021}}},
        TermCase{"DelayAndSmoothing",
                 {{free_term(FreeQuantity::Kind::kSensorDelay, LogChannel::kSpeed), 0.023},
                  {smoothing_of(LogChannel::kSpeed), 0.0017}}},
        TermCase{"SupplySag", {{supply_sag(0.6), 0.15}}},
        TermCase{"SupplySagWithLag",
                 {{supply_sag(0.6), 0.15},
                  {free_term(FreeQuantity::Kind::kDelay), 0.023},
                  {free_term(FreeQuantity::Kind::kMotorLag), 0.047},
                  {free_term(FreeQuantity::Kind::kForceImbalance), 0.06}}},
        TermCase{"RunOn",
                 {{free_term(FreeQuantity::Kind::kMotorLag), 0.12},
                  {free_term(FreeQuantity::Kind::kRunOn), 0.6}}},
        TermCase{"DeadZoneDifference",
                 {{free_term(FreeQuantity::Kind::kDeadZoneDifference), 0.03}}},
        TermCase{
            "TermsOfOneLog",
            {{free_term(FreeQuantity::Kind::kDelay), 0.013},
             {in_log(free_term(FreeQuantity::Kind::kDelay), 1), 0.021},
             {in_log(free_term(FreeQuantity::Kind::kForceScale), 1), -0.07},
             {in_log(free_term(FreeQuantity::Kind::kForceScale), 2), 0.3},
             {free_term(FreeQuantity::Kind::kForceExponent), 0.2},
             {in_log(free_term(FreeQuantity::Kind::kResistanceScale, LogChannel::kSpeed), 1), 0.15},
             {in_log(free_term(FreeQuantity::Kind::kResistanceScale, LogChannel::kYawRate), 1),
              -0.1},
             {free_term(FreeQuantity::Kind::kBias, LogChannel::kYawRate), 0.01},
             {in_log(free_term(FreeQuantity::Kind::kBias, LogChannel::kYawRate), 1), 0.02}}},
        TermCase{"AxleOffset", {{extra_force(ExtraForce::kAxleOffset), 0.3}}},
        TermCase{"Antenna",
                 {{free_term(FreeQuantity::Kind::kPositionAhead), 0.3},
                  {free_term(FreeQuantity::Kind::kPositionLeft), -0.2}}},
        TermCase{"CompassDeviation",
                 {{free_term(FreeQuantity::Kind::kCompassSin), 0.12},
                  {free_term(FreeQuantity::Kind::kCompassCos), -0.07},
                  {free_term(FreeQuantity::Kind::kCompassSin2), 0.05},
                  {free_term(FreeQuantity::Kind::kCompassCos2), -0.03}}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace awmr
