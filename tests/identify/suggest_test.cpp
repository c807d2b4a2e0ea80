/// Suggested trials: recording them gives the predicted improvement.
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/core/units.h"
#include "awmr/identify/planning/candidates.h"
#include "awmr/identify/planning/suggest.h"
#include "identify/synthetic.h"

namespace awmr::testing {
namespace {

/// Model from tables with this relative noise. Without turns, suggest() simulates only straight
/// trials, which is faster.
Model some_model(double sigma, bool has_turns = true) {
  Vehicle v = vehicle();
  v.front_axle_m = 0.35;
  v.half_track_m = 0.36;
  v.wheel_force = {-0.5, 0.5};
  v.steering_max_deg = 20.0;
  v.steering_max_rate_degps = 300.0;
  TrialData data = synthetic(kTruths[0], sigma, 3);
  if (!has_turns) data.turning.reset();
  return identify(v, data, {}, {})->model;
}

TEST(Suggest, NoCandidateIncreasesTheStandardError) {
  const auto suggestion = suggest(some_model(0.05), {.parameter = "mass_norm"});
  ASSERT_TRUE(suggestion);
  ASSERT_GT(suggestion->trials.size(), 10U);
  EXPECT_TRUE(suggestion->coasting);
  double last = 0.0;
  for (const SuggestedTrial& trial : suggestion->trials) {
    EXPECT_LE(trial.std_error_after, trial.std_error_before * (1.0 + 1e-9)) << trial.settings;
    EXPECT_GE(trial.std_error_after, last);
    EXPECT_GE(trial.d_gain, -1e-9);
    last = trial.std_error_after;
  }
  // A stop time determines m' poorly: a trial with motion must come before any turning run.
  EXPECT_TRUE(suggestion->trials.front().kind == TrialKind::kLog ||
              suggestion->trials.front().kind == TrialKind::kCoastdown);
}

TEST(Suggest, ATurnWhileCoastingIsOneThatTyresRoll) {
  const Model model = some_model(0.05);
  const std::optional<CoastingTurn> suggested = coasting_turn(model);
  ASSERT_TRUE(suggested);
  const CoastingTurn& turn = *suggested;
  EXPECT_GT(turn.speed_mps, 0.0);
  EXPECT_LE(turn.steering_deg, 10.0 * (1.0 + 1e-12));  // half of the steering limit
  // r = u tan(d_r)/(2 l_f), and the lateral acceleration u r is at most 0.2 g.
  const double rate = turn.speed_mps * std::tan(radians(turn.steering_deg)) / 0.7;
  EXPECT_NEAR(radians(turn.rolling_yaw_rate_degps), rate, 1e-12);
  EXPECT_LE(rate * turn.speed_mps, 0.2 * 9.80665 * (1.0 + 1e-12));
  Model skid = model;
  skid.vehicle.drive = Drive::kDifferential;
  EXPECT_FALSE(coasting_turn(skid));
}

TEST(Suggest, ATurningRunDoesNotImproveSurge) {
  const auto suggestion = suggest(some_model(0.05), {.parameter = "surge.beta"});
  ASSERT_TRUE(suggestion);
  for (const SuggestedTrial& trial : suggestion->trials) {
    if (trial.kind != TrialKind::kTurning) continue;
    EXPECT_NEAR(trial.std_error_after, trial.std_error_before, 1e-6 * trial.std_error_before);
  }
}

TEST(Suggest, PredictedErrorOfARepeatedTrialIsThatOfMoreRuns) {
  // n runs that measure ln u with the noise s add n (d ln u/d p)^2/s^2 to the information about a
  // parameter p. Four times the runs therefore give four times the information.
  const Model model = some_model(0.05, false);
  const auto one = suggest(model, {.parameter = "surge.beta", .repeats = 1});
  const auto four = suggest(model, {.parameter = "surge.beta", .repeats = 4});
  ASSERT_TRUE(one && four);
  const auto find = [](const Suggestion& s, double tau) {
    for (const SuggestedTrial& t : s.trials) {
      if (t.kind == TrialKind::kSurge && std::abs(t.numbers[0].second - tau) < 1e-9) return t;
    }
    ADD_FAILURE();
    return SuggestedTrial{};
  };
  const SuggestedTrial a = find(*one, 0.1);
  const SuggestedTrial b = find(*four, 0.1);
  const auto fall = [](const SuggestedTrial& t) {
    const double before = t.std_error_before * t.std_error_before;
    const double after = t.std_error_after * t.std_error_after;
    // This is x/(1 + y), with x and y proportional to the information of the trial. Four times the
    // information increase it, at most fourfold.
    return before / after - 1.0;
  };
  EXPECT_GT(fall(b), fall(a));
  EXPECT_LE(fall(b), 4.0 * fall(a));
}

TEST(Suggest, ATermFittedAsZeroHasAFiniteErrorThatTrialsShrink) {
  constexpr double kSigma = 0.02;
  Model model = some_model(0.05, false);
  model.surge_family = Family::kCoulombPower;
  model[ParameterId::kSurgeCoulomb] = {0.0, kSigma, Interval{0.0, 0.04}, Source::kFitted, ""};
  Covariance& covariance = model.covariance;
  covariance.parameters.push_back(ParameterId::kSurgeCoulomb);
  for (auto& row : covariance.matrix) row.push_back(0.0);
  covariance.matrix.emplace_back(covariance.parameters.size(), 0.0);
  covariance.matrix.back().back() = kSigma * kSigma;
  const std::string kCoulomb = "surge.coulomb";
  for (const std::string& parameter : {std::string(), kCoulomb}) {
    const auto suggestion = suggest(model, {.parameter = parameter});
    ASSERT_TRUE(suggestion);
    for (const SuggestedTrial& trial : suggestion->trials) {
      EXPECT_TRUE(std::isfinite(trial.std_error_before)) << trial.settings;
      EXPECT_TRUE(std::isfinite(trial.std_error_after)) << trial.settings;
      EXPECT_TRUE(std::isfinite(trial.d_gain)) << trial.settings;
      EXPECT_LE(trial.std_error_after, trial.std_error_before * (1.0 + 1e-9)) << trial.settings;
    }
    const SuggestedTrial& best = suggestion->trials.front();
    EXPECT_LT(best.std_error_after, best.std_error_before);
    // The standard error of an exponent is in its own unit. A variance of 1e-8 keeps C invertible.
    if (parameter == kCoulomb) {
      EXPECT_NEAR(best.std_error_before, kSigma, 1e-6);
    }
  }
}

TEST(Suggest, RefusesAnUnknownParameterAndListsTheNames) {
  const auto suggestion = suggest(some_model(0.05), {.parameter = "mass"});
  ASSERT_FALSE(suggestion);
  EXPECT_NE(to_text(suggestion.error()).find("mass_norm"), std::string::npos);
}

}  // namespace
}  // namespace awmr::testing
