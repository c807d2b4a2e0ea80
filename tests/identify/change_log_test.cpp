/// Logs of vehicles that change during the drive.
#include "awmr/identify/logs/checks/change_in_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "awmr/identify/logs/checks/held_out.h"
#include "awmr/identify/logs/problem/initial_guess.h"
#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

/// The parameters of surge and yaw are free, with initial guesses from the log only.
LogFitOptions options_for(const std::vector<DrivingLog>& logs) {
  LogFitOptions options = guessed_from(
      logs, {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta, ParameterId::kYawAlpha,
             ParameterId::kYawBeta, ParameterId::kMassNorm, ParameterId::kInertiaNorm});
  options.multistart = 1;
  options.finds_delays = false;
  return options;
}

/// Fit of the rows in a time interval.
LogFit fit_of(const std::vector<DrivingLog>& log, LogFitOptions options, const Interval& rows_s) {
  options.only_s = rows_s;
  return fit_logs(log, options);
}

/// Expects that `value` is within three standard errors of the truth, for the standard error of
/// `fit`.
void expect_within(const LogFit& fit, ParameterId id, double value, double truth) {
  const auto i = place_of(fit.quantities, id);
  ASSERT_TRUE(fit.usable && i);
  const double std_error = fit.quantities[*i].jacobian(fit.coordinates[*i]) * fit.error_of(*i);
  EXPECT_NEAR(value, truth, 3.0 * std_error) << info(id).name;
}

TEST(ChangeLog, FindsAPayload) {
  constexpr double kFirst_s = 11.0;
  constexpr double kChange_s = kFirst_s + 1.0;  // the middle of the pause
  constexpr double kPayload = 1.2;
  Truth loaded = kTruths[1];
  loaded.mass_norm *= kPayload;
  const std::vector<DrivingLog> log{log_with_change(kTruths[1], loaded, kFirst_s, 10.0, 41)};
  const LogFitOptions options = options_for(log);
  const FamilyFit whole = fit_family(log, options, Family::kPower, Family::kPower);
  const auto change = find_change(log, options, whole);
  ASSERT_TRUE(change);
  EXPECT_NEAR(change->t_s, kChange_s, 2.0);
  EXPECT_EQ(change_finding(*change, "log.csv").code, "changed-in-log");
  const LogFit before = fit_of(log, options, {0.0, kChange_s - kChangeWidth_s});
  const LogFit after = fit_of(log, options, {kChange_s + kChangeWidth_s, 100.0});
  for (const auto& [id, truth] :
       {std::pair(ParameterId::kMassNorm, kTruths[1].mass_norm),
        std::pair(ParameterId::kInertiaNorm, 0.16 * kTruths[1].mass_norm)}) {
    const auto found =
        std::ranges::find(change->quantities, std::string(info(id).name), &ChangedQuantity::name);
    ASSERT_NE(found, change->quantities.end()) << info(id).name;
    expect_within(before, id, found->before, truth);
    expect_within(after, id, found->after, kPayload * truth);
  }
}

TEST(ChangeLog, IsNotFoundWithoutAChange) {
  const std::vector<DrivingLog> log{log_with_change(kTruths[1], kTruths[1], 11.0, 10.0, 41)};
  const LogFitOptions options = options_for(log);
  EXPECT_FALSE(find_change(log, options, fit_family(log, options, Family::kPower, Family::kPower)));
}

/// p values of the tests of the last fifth of a log by a fit of its first half.
struct LastFifth {
  double predicted = 0.0;         ///< by predict()
  double likelihood_ratio = 0.0;  ///< by likelihood_ratio_test()
};

LastFifth last_fifth_of(const DrivingLog& one) {
  const std::vector<DrivingLog> log{one};
  const LogFitOptions options = options_for(log);
  const double end_s = one.t_s.back();
  const LogPart first{log, {0.0, 0.5 * end_s}, "first half"};
  const LogPart last{log, {0.8 * end_s, end_s + 1.0}, "last fifth"};
  const LogFit by_first = fit_of(log, options, first.only_s);
  const LogFit by_all = fit_logs(log, options);
  EXPECT_TRUE(by_first.usable && by_all.usable);
  const auto predicted = predict(last, by_first, options);
  const auto p_value = likelihood_ratio_test(first, last, by_first, by_all.coordinates, options);
  EXPECT_TRUE(predicted && p_value);
  return {predicted->p_value, p_value.value_or(-1.0)};
}

TEST(LastFifth, WithoutAChangeIsAccepted) {
  for (const std::uint64_t seed : {51U, 52U}) {
    const LastFifth found = last_fifth_of(log_with_change(kTruths[0], kTruths[0], 16.0, 4.0, seed));
    EXPECT_GT(found.likelihood_ratio, 0.001) << seed;
    // Near the optimum, both are the same test, except for the uncertainty of the noise.
    EXPECT_NEAR(found.likelihood_ratio, found.predicted, 0.2) << seed;
  }
}

TEST(LastFifth, WithAChangeIsRejected) {
  Truth changed = kTruths[0];
  changed.a1 *= 1.05;
  for (const std::uint64_t seed : {51U, 52U}) {
    const LastFifth found = last_fifth_of(log_with_change(kTruths[0], changed, 16.0, 4.0, seed));
    EXPECT_LT(found.predicted, 0.001) << seed;
    EXPECT_LT(found.likelihood_ratio, 0.001) << seed;
  }
}

}  // namespace
}  // namespace awmr::testing
