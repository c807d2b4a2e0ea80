/// Initial guesses of log fits, and comparison of resistance families, each at its best fit.
#include "awmr/identify/logs/choice/family_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/choice/family_fit.h"
#include "awmr/identify/logs/problem/initial_guess.h"
#include "awmr/identify/logs/problem/log_problem.h"
#include "awmr/identify/logs/problem/multistart.h"
#include "awmr/identify/logs/problem/nearest_curve.h"
#include "awmr/model/sliding.h"
#include "awmr/trials/log_start.h"
#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

/// All parameters that a log can identify are free, with initial guesses from the log only.
LogFitOptions from_nothing(const std::vector<DrivingLog>& logs) {
  return guessed_from(logs,
                      {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta, ParameterId::kYawAlpha,
                       ParameterId::kYawBeta, ParameterId::kSwayAlpha, ParameterId::kMassNorm,
                       ParameterId::kInertiaNorm, ParameterId::kSteeringTimeConstant});
}

std::vector<DrivingLog> with_coulomb_friction(double coulomb, double duration_s = 10.0) {
  Plant<double> rubbing = plant(kTruths[1]);
  rubbing.surge.coulomb = coulomb;
  Random random(8, 5);
  return {simulate_log(rubbing, robot(), {.duration_s = duration_s, .rate_hz = 50.0, .drive = 8},
                       kPreciseSensors, random)};
}

TEST(Multistart, MostStartsLeadToTheOptimum) {
  std::size_t all = 0, there = 0;
  for (const Truth& truth : kTruths) {
    for (const std::uint64_t seed : {11, 12, 13}) {
      const std::vector<DrivingLog> logs{drive(truth, seed, {.duration_s = 20.0, .rate_hz = 50.0})};
      const LogFitOptions options = from_nothing(logs);
      const Multistart search = multistart(log_problem(logs, options), options);
      ASSERT_FALSE(search.ends.empty());
      const auto chosen = std::ranges::find_if(search.starts, &SearchStart::chosen);
      ASSERT_NE(chosen, search.starts.end());
      for (const SearchStart& start : search.starts) {
        EXPECT_GE(start.cost, chosen->cost);
        ++all;
        if (start.cost < 1.01 * chosen->cost) ++there;
      }
    }
  }
  // The multistart uses short parts of windows. With whole windows of 10 s, only one of seven
  // searches ended at the optimum.
  EXPECT_GT(there, 2 * all / 3) << there << " of " << all;
}

TEST(Multistart, IsFarWorseByTheErrorsOfItsQuickSearches) {
  const auto search = [](double relative_error) {
    return Multistart{{{0.0}}, {}, relative_error, 1000};
  };
  const BestSoFar right{.relative_error = 1.0, .has_large_drift = false};
  EXPECT_FALSE(is_far_worse(search(0.9), right));
  EXPECT_FALSE(is_far_worse(search(1.09), right)) << "-2 ln L is higher by 90";
  EXPECT_TRUE(is_far_worse(search(1.11), right)) << "-2 ln L is higher by 110";
  // The noise of a wrong model is higher, so that the same errors differ less in -2 ln L.
  const BestSoFar noisy{.relative_error = 4.0, .has_large_drift = false};
  EXPECT_FALSE(is_far_worse(search(4.39), noisy));
  EXPECT_TRUE(is_far_worse(search(4.41), noisy));
  // With a large drift of the best fit, another model has to reduce the mean square in excess of
  // the sensor noise by 30 %: 1 + 0.7 (4 - 1) = 3.1, 1 + 0.7 (1.4 - 1) = 1.28.
  const BestSoFar drifting{.relative_error = 4.0, .has_large_drift = true};
  EXPECT_FALSE(is_far_worse(search(3.0), drifting));
  EXPECT_TRUE(is_far_worse(search(3.2), drifting));
  const BestSoFar little{.relative_error = 1.4, .has_large_drift = true};
  EXPECT_FALSE(is_far_worse(search(1.2), little));
  EXPECT_TRUE(is_far_worse(search(1.3), little));
  // A model that needs a large gain has to lower -2 ln L by 5, under the noise of the best fit.
  const BestSoFar good{.relative_error = 0.5, .has_large_drift = false, .needs_large_gain = true};
  EXPECT_TRUE(is_far_worse(search(0.498), good)) << "-2 ln L is lower by 4";
  EXPECT_FALSE(is_far_worse(search(0.497), good)) << "-2 ln L is lower by 6";
  EXPECT_FALSE(is_far_worse(Multistart{{{0.0}}, {}, 0.0, 0}, good)) << "no quick search";
}

TEST(NearestCurve, IsTheCurveItselfWhereTheFamilyHasIt) {
  const Resistance<double> curve{
      .alpha = 0.6, .beta = 1.0, .rest_speed = 0.0, .coulomb = 0.3, .quadratic = 0.2};
  const auto near = nearest_curve(curve, terms_of(Family::kCoulombLinearQuadratic), 2.0);
  EXPECT_NEAR(near.alpha, 0.6, 1e-12);
  EXPECT_NEAR(near.coulomb, 0.3, 1e-12);
  EXPECT_NEAR(near.quadratic, 0.2, 1e-12);
}

TEST(NearestCurve, StaysCloseOverTheSpeedsDrivenInEveryFamily) {
  for (const double beta : {0.3, 0.6, 1.0, 1.5, 2.0}) {
    const Resistance<double> curve{.alpha = 1.2, .beta = beta};
    for (const Family family : values_in(kFamilyNames)) {
      const auto near = nearest_curve(curve, terms_of(family), 1.5);
      EXPECT_GT(near.alpha, 0.0);
      EXPECT_GE(near.coulomb, 0.0);
      for (const double u : {0.5, 1.0, 1.5}) {
        EXPECT_NEAR(near.at(u), curve.at(u), 0.25 * curve.at(1.5))
            << name_of(family) << " " << beta;
      }
    }
  }
}

/// Log of a vehicle with m' = 0.09 and the resistance 0.12 + 0.35 u, exact for each step of the
/// command: slow ramps from rest in both directions, and two steps. `noise_mps`: standard deviation
/// of the speed.
DrivingLog ramps_with_friction(double noise_mps, std::uint64_t seed) {
  constexpr double kMass = 0.09, kCoulomb = 0.12, kAlpha = 0.35, kRow_s = 0.02;
  std::mt19937_64 chance(seed);
  std::normal_distribution<double> noise;
  DrivingLog log;
  log.file = "ramps.csv";
  log.steering_command_rad.emplace();
  Measured speed;
  double u = 0.0;
  for (int i = 0; i * kRow_s < 52.0; ++i) {
    const double t = i * kRow_s;
    const double thrust = t < 2.0    ? 0.0
                          : t < 16.0 ? 0.04 * (t - 2.0)
                          : t < 20.0 ? 0.0
                          : t < 34.0 ? -0.04 * (t - 20.0)
                          : t < 38.0 ? 0.0
                          : t < 42.0 ? 0.7
                          : t < 45.0 ? 0.0
                          : t < 49.0 ? -0.7
                                     : 0.0;
    log.line.push_back(i + 2);
    log.t_s.push_back(t);
    log.force_left.push_back(thrust / 4.0);
    log.force_right.push_back(thrust / 4.0);
    log.steering_command_rad->push_back(0.0);
    speed.value.push_back(u + noise_mps * noise(chance));
    speed.fresh.push_back(true);
    // Speed over a step with motion in the direction s:
    //   u(t) = u_end + (u - u_end) exp(-a t/m'),   u_end = (thrust - s c)/a
    double left_s = kRow_s;
    while (left_s > 0.0) {
      if (u == 0.0 && std::abs(thrust) <= kCoulomb) break;
      const double way = u != 0.0 ? std::copysign(1.0, u) : std::copysign(1.0, thrust);
      const double end = (thrust - way * kCoulomb) / kAlpha;
      const double stop_s = way * end < 0.0 && u != 0.0
                                ? kMass / kAlpha * std::log((u - end) / -end)
                                : std::numeric_limits<double>::infinity();
      const double span_s = std::min(left_s, stop_s);
      u = stop_s <= left_s ? 0.0 : end + (u - end) * std::exp(-kAlpha * span_s / kMass);
      left_s -= span_s;
    }
  }
  speed.fresh_count = static_cast<int>(speed.value.size());
  log[LogChannel::kSpeed] = std::move(speed);
  return log;
}

/// Log of straight driving with thrust steps of 0.5 to 2 s, m' = 0.5, resistance 2.2 u and motors
/// with the lag `lag_s`; only the speed is measured.
DrivingLog steps_behind_lag(double lag_s, std::uint64_t seed) {
  constexpr double kMass = 0.5, kAlpha = 2.2, kRow_s = 0.02, kFine_s = 1e-4, kNoise_mps = 0.005;
  std::mt19937_64 chance(seed);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> part(0.0, 1.0);
  DrivingLog log;
  log.file = "steps.csv";
  log.steering_command_rad.emplace();
  Measured speed;
  double u = 0.0, force = 0.0, command = 0.0, until_s = 0.0;
  for (int i = 0; i * kRow_s < 40.0; ++i) {
    const double t = i * kRow_s;
    if (t >= until_s) {
      until_s = t + 0.5 + 1.5 * part(chance);
      command = 0.2 + 1.6 * part(chance);
    }
    log.line.push_back(i + 2);
    log.t_s.push_back(t);
    log.force_left.push_back(command / 4.0);
    log.force_right.push_back(command / 4.0);
    log.steering_command_rad->push_back(0.0);
    speed.value.push_back(u + kNoise_mps * noise(chance));
    speed.fresh.push_back(true);
    for (double at_s = 0.0; at_s < kRow_s - 0.5 * kFine_s; at_s += kFine_s) {
      const double next = command + (force - command) * std::exp(-kFine_s / lag_s);
      const double end = 0.5 * (force + next) / kAlpha;
      u = end + (u - end) * std::exp(-kAlpha * kFine_s / kMass);
      force = next;
    }
  }
  speed.fresh_count = static_cast<int>(speed.value.size());
  log[LogChannel::kSpeed] = std::move(speed);
  return log;
}

TEST(Families, OfMotorsThatLagLeaveTheMassRightWhereOnlyTheSpeedIsMeasured) {
  for (const double lag_s : {0.06, 0.1}) {
    TrialData data;
    data.logs = {steps_behind_lag(lag_s, 5)};
    const auto result = identify(robot(), data, {}, {});
    ASSERT_TRUE(result);
    const Estimate& mass = result->model[ParameterId::kMassNorm];
    ASSERT_TRUE(mass.value && mass.std_error) << lag_s;
    EXPECT_LT(std::abs(*mass.value - 0.5), 4.0 * *mass.std_error) << lag_s;
    const auto& findings = result->model.record.findings;
    EXPECT_TRUE(std::ranges::any_of(findings, [](const Finding& f) {
      return f.code == "actuator-lag";
    })) << lag_s;
  }
}

/// Log of a drive that never coasts. The vehicle has the resistances of `vehicle`, and motors with
/// the time constant `lag_s`.
DrivingLog driven_throughout(const Plant<double>& vehicle, double lag_s, std::uint64_t seed) {
  DrivingLog log = drive(kTruths[1], seed, {.duration_s = 20.0, .rate_hz = 25.0});
  remove_pose(log);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    if (log.force_left[i] == 0.0 && log.force_right[i] == 0.0) {
      log.force_left[i] = log.force_right[i] = 0.3;
    }
  }
  log = measured_behind_lag(std::move(log), resolved_beside_friction(vehicle, kSimulationStep_s),
                            lag_s, seed, true);
  add_row_of_rest(log);
  return log;
}

/// The fit must choose the yaw family before the surge family: with a wrong yaw family (power law),
/// the errors of the yaw motion hide the Coulomb friction of surge.
TEST(Families, OfSurgeAreComparedOnceTheYawFamilyIsRight) {
  Plant<double> vehicle = plant(kTruths[1]);
  vehicle.surge = {.alpha = 1.0, .beta = 1.0, .coulomb = 0.25};
  vehicle.yaw = {.alpha = 0.25, .beta = 1.0, .coulomb = 0.03};
  TrialData data;
  data.logs = {driven_throughout(vehicle, 0.15, 2)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(terms_of(result->model.surge_family).coulomb);
  EXPECT_TRUE(terms_of(result->model.yaw_family).coulomb);
  const Estimate& friction = result->model[ParameterId::kSurgeCoulomb];
  ASSERT_TRUE(friction.value);
  EXPECT_NEAR(*friction.value, 0.25, 0.03);
}

/// Test parameter: standard deviation of the speed's noise, m/s.
class FamiliesAtNoise : public ::testing::TestWithParam<double> {};

TEST_P(FamiliesAtNoise, AreIdentifiedRightWithFrictionFromRest) {
  TrialData data;
  data.logs = {ramps_with_friction(GetParam(), 17)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  const Model& model = result->model;
  EXPECT_TRUE(terms_of(model.surge_family).coulomb);
  // Two parameters and six logs: with 4 standard errors, the test fails by chance with a
  // probability of 8e-4.
  for (const auto& [id, truth] :
       {std::pair(ParameterId::kSurgeCoulomb, 0.12), std::pair(ParameterId::kMassNorm, 0.09)}) {
    ASSERT_TRUE(model[id].value && model[id].std_error) << info(id).name;
    EXPECT_LT(std::abs(*model[id].value - truth), 4.0 * *model[id].std_error) << info(id).name;
  }
}
INSTANTIATE_TEST_SUITE_P(Short, FamiliesAtNoise, ::testing::Values(1e-5));
INSTANTIATE_TEST_SUITE_P(Long, FamiliesAtNoise, ::testing::Values(5e-4, 1e-3, 5e-3, 2e-2, 5e-2));

TEST(Families, DropTermsOfThePreviousFamily) {
  const std::vector<DrivingLog> logs = with_coulomb_friction(0.2);
  const LogFitOptions options = from_nothing(logs);
  const FamilyFit rubbing = fit_family(logs, options, Family::kCoulombPower, Family::kPower);
  ASSERT_TRUE(rubbing.fit.usable);
  ASSERT_GT(fitted_values(rubbing.options, rubbing.fit)[at(ParameterId::kSurgeCoulomb)], 0.1);
  for (const Family other : {Family::kDeadZone, Family::kPower}) {
    const FamilyFit fit = fit_from(logs, options, rubbing, other, Family::kPower);
    EXPECT_EQ(fitted_values(fit.options, fit.fit)[at(ParameterId::kSurgeCoulomb)], 0.0)
        << "a fixed Coulomb term of the other family would be in the fit but not in the model";
    EXPECT_GT(aic_lead(rubbing.fit, fit.fit), 10.0);
  }
}

TEST(Families, FirstFitAddsCoulombFrictionOnlyIfTheVehicleHasIt) {
  for (const double coulomb : {0.0, 0.2}) {
    const std::vector<DrivingLog> logs = with_coulomb_friction(coulomb);
    LogFitOptions options = from_nothing(logs);
    options.optional_coulomb = {ParameterId::kSurgeCoulomb, ParameterId::kYawCoulomb};
    const FamilyFit first = fit_family(logs, options, Family::kPower, Family::kPower);
    ASSERT_TRUE(first.fit.usable);
    EXPECT_EQ(first.surge, coulomb > 0.0 ? Family::kCoulombPower : Family::kPower);
    EXPECT_EQ(first.yaw, Family::kPower);
    EXPECT_EQ(first.options.frees(ParameterId::kSurgeCoulomb), coulomb > 0.0);
    EXPECT_TRUE(first.options.optional_coulomb.empty());
    const double fitted = fitted_values(first.options, first.fit)[at(ParameterId::kSurgeCoulomb)];
    EXPECT_NEAR(fitted, coulomb, 0.05);
  }
}

TEST(Families, SearchesAgainFromABetterAlternative) {
  const std::vector<DrivingLog> logs{drive(kTruths[0], 9, {.duration_s = 20.0, .rate_hz = 50.0})};
  const LogFitOptions options = from_nothing(logs);
  const FamilyFit alternative = fit_family(logs, options, Family::kCoulombPower, Family::kPower);
  ASSERT_TRUE(alternative.fit.usable);
  FamilyFit unlucky{Family::kPower, Family::kPower, options, {}};
  const FamilyFit again = searched_again(logs, options, unlucky, alternative);
  ASSERT_TRUE(again.fit.usable);
  EXPECT_EQ(again.surge, Family::kPower);
  EXPECT_LT(aic_lead(alternative.fit, again.fit), 10.0);
  const FamilyFit kept = searched_again(logs, options, again, unlucky);
  EXPECT_EQ(kept.fit.coordinates, again.fit.coordinates)
      << "an alternative without a fit is ignored";
}

TEST(Families, ReportALimitThatEndsTheLastSearch) {
  const std::vector<DrivingLog> logs = with_coulomb_friction(0.2);
  const auto compared = [&](std::int64_t limit) {
    LogFitOptions options = from_nothing(logs);
    options.effort = std::make_shared<Effort>(limit);
    FamilyFit first = fit_family(logs, options, Family::kPower, Family::kPower);
    const FamilyContest contest{.open = {.surge = true, .yaw = false}, .only_candidates = false};
    const BestFamily found = best_family(logs, options, std::move(first), contest);
    return std::pair(found.is_out_of_time, options.effort->spent());
  };
  const auto [is_over, spent] = compared(std::numeric_limits<std::int64_t>::max());
  EXPECT_FALSE(is_over);
  EXPECT_TRUE(compared(spent - 1).first);
}

TEST(Families, ComparesFamiliesAtTheirOwnOptima) {
  const std::vector<DrivingLog> logs{
      drive(kTruths[0], 10, {.duration_s = 20.0, .rate_hz = 50.0}, kPreciseSensors)};
  const LogFitOptions options = from_nothing(logs);
  FamilyFit unlucky{Family::kPower, Family::kPower, options, {}};
  const BestFamily found = best_family(logs, options, unlucky, {.lead = 20.0});
  EXPECT_TRUE(found.best.fit.usable);
  EXPECT_EQ(found.best.surge, Family::kPower);
  EXPECT_TRUE(found.findings.empty()) << found.findings.front().message;
}

TEST(Families, GiveUpIfTheirErrorsAreFarAboveTheLimit) {
  const std::vector<DrivingLog> logs = with_coulomb_friction(0.4, 20.0);
  LogFitOptions options = from_nothing(logs);
  options.give_up_above = 1.5;
  const FamilyFit hopeless = fit_family(logs, options, Family::kPower, Family::kPower);
  EXPECT_TRUE(hopeless.fit.gave_up);
  EXPECT_FALSE(hopeless.fit.usable);
  EXPECT_GT(hopeless.fit.relative_error, 1.5);
  EXPECT_FALSE(std::isfinite(hopeless.options.give_up_above)) << "later fits have no limit";
  const FamilyFit right = fit_family(logs, options, Family::kCoulombPower, Family::kPower);
  EXPECT_TRUE(right.fit.usable);
  EXPECT_NEAR(right.fit.relative_error, 1.0, 0.2);
}

TEST(Families, AreScreenedFromAPowerLawThatGaveUp) {
  const std::vector<DrivingLog> logs = with_coulomb_friction(0.4);
  LogFitOptions options = from_nothing(logs);
  const FamilyFit power = fit_family(logs, options, Family::kPower, Family::kPower);
  const FamilyFit likely = likely_families(logs, options, power, {.surge = true, .yaw = true});
  EXPECT_TRUE(terms_of(likely.surge).coulomb || terms_of(likely.surge).dead_zone);
  const FamilyFit kept = likely_families(logs, options, power, {.surge = false, .yaw = false});
  EXPECT_EQ(kept.surge, Family::kPower);
  EXPECT_EQ(kept.yaw, Family::kPower);
}

/// The score tests of other terms must not depend on whether a freed term is in the list.
TEST(Families, TestNoTermsThatTheyHave) {
  const std::vector<DrivingLog> logs = with_coulomb_friction(0.2);
  LogFitOptions options = from_nothing(logs);
  options.finds_delays = false;
  options.candidate_terms = {ParameterId::kSurgeCoulomb, ParameterId::kYawCoulomb};
  const LogFit both = fit_family(logs, options, Family::kCoulombLinear, Family::kPower).fit;
  options.candidate_terms = {ParameterId::kYawCoulomb};
  const LogFit one = fit_family(logs, options, Family::kCoulombLinear, Family::kPower).fit;
  ASSERT_EQ(both.candidate_gain.size(), 2U);
  EXPECT_EQ(both.candidate_gain[0], 0.0);
  EXPECT_EQ(both.candidate_gain[1], one.candidate_gain.at(0));
}

/// Test parameter: true to compare families of yaw too.
class InexactPositions : public ::testing::TestWithParam<bool> {};

TEST_P(InexactPositions, FamiliesAreCompared) {
  DrivingLog log = drive(kTruths[1], 4, {.duration_s = 3.0});
  for (const LogChannel channel :
       {LogChannel::kSpeed, LogChannel::kYawRate, LogChannel::kHeading, LogChannel::kSway}) {
    log[channel].reset();
  }
  Random random(5, 9);
  for (const LogChannel channel : {LogChannel::kX, LogChannel::kY}) {
    for (double& value : log[channel]->value) value += 2.0 * random.normal();
  }
  const std::vector<DrivingLog> logs{log};
  const LogFitOptions options = from_nothing(logs);
  FamilyFit first = fit_family(logs, options, Family::kPower, Family::kPower);
  const FamilyContest contest{.open = {.surge = true, .yaw = GetParam()}, .only_candidates = false};
  const BestFamily found = best_family(logs, options, std::move(first), contest);
  EXPECT_TRUE(found.best.fit.usable);
}
INSTANTIATE_TEST_SUITE_P(Short, InexactPositions, ::testing::Values(false));
INSTANTIATE_TEST_SUITE_P(Long, InexactPositions, ::testing::Values(true));

/// Returns a fit with these speed errors at 100 Hz and their most likely noise.
LogFit fit_with_errors(const std::vector<double>& errors) {
  ErrorSeries series{errors, std::vector<double>(errors.size(), 0.01)};
  series.since_s.front() = 0.0;
  LogFit fit;
  fit.errors[{LogChannel::kSpeed}] = {series};
  fit.noise[{LogChannel::kSpeed}] =
      likeliest_noise(fit.errors[{LogChannel::kSpeed}], 1.0, {.sensor_std = 1e-4});
  fit.usable = true;
  return fit;
}

TEST(FamilyFit, ResetsTermsThatItDoesNotEstimate) {
  ParameterValues<double> power_law{}, values{};
  values[at(ParameterId::kSurgeAlpha)] = 2.0;    // in every family: never reset
  values[at(ParameterId::kSurgeCoulomb)] = 0.3;  // estimated
  values[at(ParameterId::kYawCoulomb)] = 0.05;   // of another fit
  power_law[at(ParameterId::kYawQuadratic)] = 0.01;
  reset_terms({ParameterId::kSurgeCoulomb}, power_law, values);
  EXPECT_EQ(values[at(ParameterId::kSurgeAlpha)], 2.0);
  EXPECT_EQ(values[at(ParameterId::kSurgeCoulomb)], 0.3);
  EXPECT_EQ(values[at(ParameterId::kYawCoulomb)], 0.0);
  EXPECT_EQ(values[at(ParameterId::kYawQuadratic)], 0.01);
}

TEST(Families, AreComparedUnderTheNoiseOfTheSmallerErrors) {
  std::mt19937 random(3);
  std::normal_distribution<double> white;
  std::vector<double> small, smooth;
  for (int k = 0; k < 6000; ++k) {
    small.push_back(3e-3 * white(random));
    smooth.push_back(0.2 * std::sin(0.01 * k));
  }
  const LogFit right = fit_with_errors(small), wrong = fit_with_errors(smooth);
  EXPECT_TRUE(wrong.noise.at({LogChannel::kSpeed}).overwhelms_sensor());
  EXPECT_LT(wrong.noise.at({LogChannel::kSpeed}).cost, right.noise.at({LogChannel::kSpeed}).cost)
      << "if each fit is compared under its own noise, the wrong one is better";
  EXPECT_GT(aic_lead(right, wrong), 1e4);
  EXPECT_EQ(aic_lead(right, wrong), -aic_lead(wrong, right));
  LogFit none;
  EXPECT_EQ(aic_lead(right, none), std::numeric_limits<double>::infinity());
  EXPECT_EQ(aic_lead(none, none), 0.0);
}

TEST(Families, AreComparedInMostRowsWithoutAFewLargeErrors) {
  std::mt19937 random(4);
  std::normal_distribution<double> white;
  std::vector<double> with_outliers, larger;
  for (int k = 0; k < 6000; ++k) {
    with_outliers.push_back(3e-3 * white(random) + (k % 1000 == 500 ? 0.2 : 0.0));
    larger.push_back(3.3e-3 * white(random));
  }
  const LogFit a = fit_with_errors(with_outliers), b = fit_with_errors(larger);
  EXPECT_LT(aic_lead(a, b), -1000.0);
  EXPECT_GT(aic_lead(a, b, kMaxSquaredInnovation), 100.0);
  EXPECT_EQ(aic_lead(a, b, kMaxSquaredInnovation), -aic_lead(b, a, kMaxSquaredInnovation));
  EXPECT_EQ(aic_lead(a, LogFit{}, kMaxSquaredInnovation), std::numeric_limits<double>::infinity());
}

TEST(Multistart, UsesPartsOfAboutFiftyRowsOrMore) {
  for (const double rate_hz : {5.0, 100.0}) {
    const std::vector<DrivingLog> logs = {
        drive(kTruths[1], 8, {.duration_s = 60.0, .rate_hz = rate_hz})};
    const LogProblem rough = rough_problem(log_problem(logs, from_nothing(logs)));
    ASSERT_FALSE(rough.windows.empty());
    for (const FitWindow& part : rough.windows) {
      EXPECT_GE(part.rows.end - part.rows.begin, 40U) << rate_hz;
    }
  }
}

TEST(Windows, PartsContainEverySampleOnce) {
  const std::vector<DrivingLog> logs{drive(kTruths[0], 4)};
  for (const FitWindow& window : fit_windows(logs, kWindow_s)) {
    std::size_t samples = 0, next = window.rows.begin;
    for (const FitWindow& part : parts_of(window, 2.5)) {
      EXPECT_EQ(part.rows.begin, next);
      next = part.rows.end;
      EXPECT_LE(logs[0].t_s[part.rows.end - 1] - logs[0].t_s[part.rows.begin], 2.5);
      EXPECT_EQ(part.samples().front().since_s, 0.0);
      samples += part.samples().size();
    }
    EXPECT_EQ(next, window.rows.end);
    EXPECT_EQ(samples, window.samples().size());
    EXPECT_EQ(parts_of(window, 100.0).size(), 1U);
  }
}

TEST(FamilyChoice, FindsCoulombFrictionTogetherWithADeadZone) {
  const Truth& t = kTruths[1];
  Plant<double> rubbing = plant(t);
  rubbing.surge = {.alpha = 0.9, .beta = 0.8, .coulomb = 0.3};
  rubbing.wheel_dead_zone = 0.06;
  Random random(3, 5);
  TrialData data;
  data.logs = {simulate_log(rubbing, robot(), {.duration_s = 40.0, .rate_hz = 50.0, .drive = 3},
                            kPreciseSensors, random)};
  const auto result = identify(robot(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->model.surge_family, Family::kDeadZoneCoulomb);
  expect_recovered(*result, ParameterId::kSurgeCoulomb, 0.3, 4.0);
  expect_recovered(*result, ParameterId::kWheelDeadZone, 0.06, 4.0);
  expect_recovered(*result, ParameterId::kSurgeAlpha, 0.9, 4.0);
  expect_recovered(*result, ParameterId::kMassNorm, t.mass_norm, 4.0);
}

}  // namespace
}  // namespace awmr::testing
