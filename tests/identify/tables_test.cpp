/// Fits of tables of steady runs: resistance families, robust losses, outliers and influence of
/// runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/option_text.h"
#include "awmr/identify/tables/steady_fit.h"
#include "awmr/identify/tables/subject.h"
#include "awmr/model/steady.h"
#include "identify/synthetic.h"

namespace awmr::testing {
namespace {

const Finding* finding(const Model& model, const std::string& code) {
  for (const Finding& f : model.record.findings) {
    if (f.code == code) return &f;
  }
  return nullptr;
}

/// Twelve surge runs of a resistance law, with normal speed errors of standard deviation `noise`,
/// m/s.
TrialData runs_on(const Resistance<double>& law, double dead_zone, double noise,
                  std::uint64_t seed) {
  Random random(seed, 3);
  TrialData data;
  data.surge = TrialSet<SurgeRow>{"surge.csv", {}, 0};
  for (int i = 1; i <= 12; ++i) {
    const double speed = 0.15 * i;
    data.surge->rows.push_back(
        {i + 1, law.at(speed) + 4.0 * dead_zone, speed + noise * random.normal(), {}, {}});
  }
  return data;
}

IdentifyOptions family(std::optional<Family> family) {
  IdentifyOptions options;
  options.surge_family.family = family;
  return options;
}

TEST(Families, ExactRunsGiveTheirOwnFamilyBack) {
  // One law of each family. The speeds are exact, so only rounding errors remain: 1e-12 of the
  // speeds, multiplied by a condition number below 1e4.
  const struct {
    Family family;
    Resistance<double> law;
    double dead_zone;
  } cases[] = {
      {Family::kCoulombLinear, {.alpha = 1.1, .beta = 1.0, .coulomb = 0.2}, 0.0},
      {Family::kCoulombLinearQuadratic,
       {.alpha = 0.7, .beta = 1.0, .coulomb = 0.2, .quadratic = 0.3},
       0.0},
      {Family::kCoulombPower, {.alpha = 1.1, .beta = 0.6, .coulomb = 0.2}, 0.0},
      {Family::kDeadZone, {.alpha = 1.3, .beta = 0.7}, 0.05},
  };
  for (const auto& c : cases) {
    const auto result =
        identify(vehicle(), runs_on(c.law, c.dead_zone, 0.0, 1), family(c.family), {});
    ASSERT_TRUE(result);
    const Model& m = result->model;
    EXPECT_EQ(m.surge_family, c.family);
    EXPECT_NEAR(*m[ParameterId::kSurgeAlpha].value, c.law.alpha, 1e-7) << name_of(c.family);
    EXPECT_NEAR(*m[ParameterId::kSurgeBeta].value, c.law.beta, 1e-7) << name_of(c.family);
    EXPECT_NEAR(*m[ParameterId::kSurgeCoulomb].value, c.law.coulomb, 1e-7) << name_of(c.family);
    EXPECT_NEAR(*m[ParameterId::kSurgeQuadratic].value, c.law.quadratic, 1e-7) << name_of(c.family);
    EXPECT_NEAR(*m[ParameterId::kWheelDeadZone].value, c.dead_zone, 1e-7) << name_of(c.family);
  }
}

TEST(Families, AutoSelectsThePowerLawOnlyIfItIsTheTruth) {
  const Resistance<double> power{.alpha = 1.3157, .beta = 0.8841};
  const auto plain = identify(vehicle(), runs_on(power, 0.0, 0.005, 4), family({}), {});
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->model.surge_family, Family::kPower);
  EXPECT_EQ(finding(plain->model, "power-law-inadequate"), nullptr);

  const Resistance<double> stiff{.alpha = 0.5, .beta = 1.0, .coulomb = 0.5};
  const auto other = identify(vehicle(), runs_on(stiff, 0.0, 0.005, 4), family({}), {});
  ASSERT_TRUE(other);
  EXPECT_NE(other->model.surge_family, Family::kPower);
  const auto forced = identify(vehicle(), runs_on(stiff, 0.0, 0.005, 4), {}, {});
  ASSERT_TRUE(forced);
  const Finding* verdict = finding(forced->model, "power-law-inadequate");
  ASSERT_NE(verdict, nullptr);
  EXPECT_THAT(verdict->message,
              ::testing::HasSubstr("use " + option_text("family surge=coulomb-linear")));
  // After the user has followed this advice, the power law is no longer mentioned.
  const auto followed =
      identify(vehicle(), runs_on(stiff, 0.0, 0.005, 4), family(Family::kCoulombLinear), {});
  ASSERT_TRUE(followed);
  EXPECT_EQ(finding(followed->model, "power-law-inadequate"), nullptr);
  EXPECT_FALSE(forced->model[ParameterId::kSurgeAlpha].ci95);
  EXPECT_TRUE(plain->model[ParameterId::kSurgeAlpha].ci95);
}

/// Five turns to each side at two forces, with 0.3 % of noise in the yaw rate. A constant moment
/// `pull_m`, positive to the left, acts on all.
TrialData turns_to_both_sides(double pull_m, std::uint64_t seed) {
  const Resistance<double> yaw{.alpha = 0.12, .beta = 0.9};
  Random random(seed, 5);
  TrialData data = runs_on({.alpha = 1.3, .beta = 0.9}, 0.0, 0.0, 1);
  data.turning = TrialSet<TurningRow>{"turning.csv", {}, 0};
  int line = 2;
  for (const double side : {1.0, -1.0}) {
    for (int i = 1; i <= 5; ++i) {
      for (const double force : {0.3, 0.6}) {
        const double moment = 0.4 * force * std::sin(0.08 * i);
        const double rate = *steady_rate(yaw, moment + side * pull_m);
        data.turning->rows.push_back({.line = line++,
                                      .steering_rad = 0.08 * i,
                                      .wheel_force = force,
                                      .tau_turn_m = moment,
                                      .yaw_rate_radps = rate * (1.0 + 0.003 * random.normal()),
                                      .turns = {},
                                      .elapsed_s = {},
                                      .is_right_turn = side < 0.0});
      }
    }
  }
  return data;
}

TEST(Turns, ThatDifferBySideGiveNoIntervals) {
  for (const double pull_m : {-0.003, 0.003}) {
    const auto result = identify(vehicle(), turns_to_both_sides(pull_m, 1), {}, {});
    ASSERT_TRUE(result);
    const Finding* differ = finding(result->model, "turns-differ");
    ASSERT_NE(differ, nullptr);
    EXPECT_THAT(differ->message,
                ::testing::HasSubstr(pull_m > 0.0 ? "to the left" : "to the right"));
    EXPECT_FALSE(result->model[ParameterId::kYawBeta].ci95);
    EXPECT_TRUE(result->model[ParameterId::kSurgeBeta].ci95);
  }
}

TEST(Turns, ThatAgreeAreSeldomSaidToDiffer) {
  IdentifyOptions options;
  options.side_by_side = false;  // no alternative fits, which do not affect this comparison
  const auto pulled = identify(vehicle(), turns_to_both_sides(0.003, 1), options, {});
  ASSERT_TRUE(pulled);
  EXPECT_NE(finding(pulled->model, "turns-differ"), nullptr);
  int differ = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto result = identify(vehicle(), turns_to_both_sides(0.0, seed), options, {});
    ASSERT_TRUE(result);
    differ += finding(result->model, "turns-differ") != nullptr;
  }
  EXPECT_LE(differ, 4);  // level 1 %: more than 4 of 100 with probability 0.3 %
}

/// Steady runs show only the sum of the Coulomb friction and the dead zones.
TEST(Families, DeadZoneWithCoulombFrictionNeedsLogs) {
  const auto result =
      identify(vehicle(), runs_on({.alpha = 1.0, .beta = 1.0, .coulomb = 0.2}, 0.05, 0.0, 1),
               family(Family::kDeadZoneCoulomb), {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().faults.front().code, ErrorCode::kUnsupported);
}

TEST(Families, DeadZoneOfTheWheelsIsSubtractedFromTheTurningRuns) {
  const Resistance<double> surge{.alpha = 1.3, .beta = 0.7};
  const Resistance<double> yaw{.alpha = 0.3, .beta = 0.8};
  constexpr double kZone = 0.05;
  TrialData data = runs_on(surge, kZone, 0.0, 1);
  data.turning = TrialSet<TurningRow>{"turning.csv", {}, 0};
  for (int i = 1; i <= 6; ++i) {
    const double force = 0.1 + 0.02 * i;
    const double per_force = 0.2;  // 2 l_f sin d_r
    const double rate = *steady_rate(yaw, per_force * (force - kZone));
    data.turning->rows.push_back({.line = i + 1,
                                  .steering_rad = 0.3,
                                  .wheel_force = force,
                                  .tau_turn_m = per_force * force,
                                  .yaw_rate_radps = rate,
                                  .turns = {},
                                  .elapsed_s = {}});
  }
  IdentifyOptions options = family(Family::kDeadZone);
  const auto result = identify(vehicle(), data, options, {});
  ASSERT_TRUE(result);
  EXPECT_NEAR(*result->model[ParameterId::kYawAlpha].value, 0.3, 1e-6);
  EXPECT_NEAR(*result->model[ParameterId::kYawBeta].value, 0.8, 1e-6);
}

TEST(Losses, RobustOnesIgnoreABadRunThatSquaresFollow) {
  const Resistance<double> law{.alpha = 1.3157, .beta = 0.8841};
  TrialData data = runs_on(law, 0.0, 0.003, 2);
  data.surge->rows[10].speed_mps *= 0.7;
  IdentifyOptions squares;
  squares.method = Method::kNonlinear;
  squares.keeps_outliers = true;
  const double by_squares =
      *identify(vehicle(), data, squares, {})->model[ParameterId::kSurgeBeta].value;
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy, Loss::kTukey}) {
    IdentifyOptions options;
    options.loss = loss;
    options.noise =
        ErrorModel::kSpeed;  // the errors of runs_on(); the default with a loss is force
    const auto result = identify(vehicle(), data, options, {});
    ASSERT_TRUE(result);
    const Estimate& beta = result->model[ParameterId::kSurgeBeta];
    // The other eleven runs determine b1 to about 0.004. With a squared loss, the outlier changes
    // b1 by ten times that.
    EXPECT_NEAR(*beta.value, law.beta, 0.02) << static_cast<int>(loss);
    EXPECT_LT(std::abs(*beta.value - law.beta), 0.3 * std::abs(by_squares - law.beta));
    EXPECT_TRUE(beta.ci95->contains(law.beta)) << static_cast<int>(loss);
  }
}

TEST(Outliers, AreNamedWithTheirLineAndTheirInfluence) {
  TrialData data = runs_on({.alpha = 1.3157, .beta = 0.8841}, 0.0, 0.003, 2);
  data.surge->rows[10].speed_mps *= 0.7;
  const auto result = identify(vehicle(), data, {.keeps_outliers = true}, {});
  ASSERT_TRUE(result);
  const Finding* outlier = finding(result->model, "outlier");
  ASSERT_NE(outlier, nullptr);
  EXPECT_EQ(outlier->line, data.surge->rows[10].line);
  const auto influential =
      std::find_if(result->model.record.findings.begin(), result->model.record.findings.end(),
                   [&](const Finding& f) {
                     return f.code == "influential-row" && f.line == data.surge->rows[10].line;
                   });
  ASSERT_NE(influential, result->model.record.findings.end());
  EXPECT_THAT(influential->message, ::testing::HasSubstr("surge.alpha becomes"));
}

TEST(Outliers, GrossOnesAreSetAsideWithTheirLine) {
  for (const double factor : {1e-3, 0.1, 0.5, 10.0}) {
    const TrialData clean = runs_on({.alpha = 1.3157, .beta = 0.8841}, 0.0, 0.003, 2);
    TrialData data = clean;
    data.surge->rows[4].speed_mps *= factor;
    TrialData without = clean;
    without.surge->rows.erase(without.surge->rows.begin() + 4);
    const auto result = identify(vehicle(), data, {}, {});
    const auto expected = identify(vehicle(), without, {}, {});
    ASSERT_TRUE(result && expected);
    EXPECT_TRUE(std::ranges::any_of(result->model.record.findings, [&](const Finding& f) {
      return f.code == "outlier" && f.line == data.surge->rows[4].line;
    })) << factor;
    EXPECT_EQ(result->model[ParameterId::kSurgeBeta].value,
              expected->model[ParameterId::kSurgeBeta].value);
  }
}

/// Nine runs over 6 m, from 14.6 s down to 1.4 s, timed by a stop-watch.
TrialData timed_runs(double timing_std_s, std::uint64_t seed) {
  Random random(seed, 4);
  const Resistance<double> law{.alpha = 1.5, .beta = 0.7};
  constexpr double kDistance_m = 6.0;
  TrialData data;
  data.surge = TrialSet<SurgeRow>{"surge.csv", {}, 0};
  for (int i = 2; i <= 10; ++i) {
    const double tau = 0.4 * i;
    const double elapsed_s = kDistance_m / *steady_rate(law, tau) + timing_std_s * random.normal();
    data.surge->rows.push_back({i, tau, kDistance_m / elapsed_s, kDistance_m, elapsed_s});
  }
  return data;
}

class OutlierTables : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Short, OutlierTables, ::testing::Values(40));
INSTANTIATE_TEST_SUITE_P(Long, OutlierTables, ::testing::Values(100));

TEST_P(OutlierTables, OfRunsWithEqualErrorsOfTheirTimesHaveThemAsRarelyAsTheLevelStates) {
  int named = 0;
  for (int seed = 1; seed <= GetParam(); ++seed) {
    const auto result =
        identify(vehicle(), timed_runs(0.1, static_cast<std::uint64_t>(seed)), {}, {});
    ASSERT_TRUE(result);
    named += finding(result->model, "outlier") != nullptr;
  }
  // At most 5 % of the tables may have the finding by chance, plus 2.3 standard deviations.
  EXPECT_LE(named, 0.05 * GetParam() + 2.3 * std::sqrt(0.05 * 0.95 * GetParam()));
}

class OutlierSeeds : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Short, OutlierSeeds, ::testing::Values(1));
INSTANTIATE_TEST_SUITE_P(Long, OutlierSeeds, ::testing::Values(11, 21, 31));

TEST_P(OutlierSeeds, OfTimedRunsAreSetAsideByTheirTime) {
  for (std::uint64_t seed = GetParam(); seed < GetParam() + 10; ++seed) {
    TrialData data = timed_runs(0.15, seed);
    const auto clean = identify(vehicle(), data, {}, {});
    ASSERT_TRUE(clean);
    EXPECT_EQ(clean->model.record.reports.front().rows_used, 9) << seed;
    SurgeRow& wrong = data.surge->rows[2];
    wrong.elapsed_s = *wrong.elapsed_s * 10.0;
    wrong.speed_mps /= 10.0;
    const auto result = identify(vehicle(), data, {}, {});
    ASSERT_TRUE(result);
    const Finding* outlier = finding(result->model, "outlier");
    ASSERT_NE(outlier, nullptr) << seed;
    EXPECT_EQ(outlier->line, wrong.line) << seed;
    EXPECT_EQ(result->model.record.reports.front().rows_used, 8) << seed;
  }
}

TEST(Outliers, RunsThatCoulombFrictionExplainsAreKept) {
  // The slowest run differs much from every power law that is fitted to the other runs.
  TrialData data = runs_on({.alpha = 0.8, .beta = 1.0, .coulomb = 0.1}, 0.0, 1e-4, 3);
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->model.record.reports.front().rows_used, 12);
}

TEST(Outliers, LeaveOneOutEqualsAFitWithoutTheRow) {
  const TrialData data = runs_on({.alpha = 1.3157, .beta = 0.8841}, 0.0, 0.02, 5);
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  const EstimatorReport& report = result->model.record.reports.front();
  ASSERT_EQ(report.leave_one_out.size(), 12U);
  TrialData without = data;
  without.surge->rows.erase(without.surge->rows.begin() + 3);
  const auto refit = identify(vehicle(), without, {}, {});
  EXPECT_EQ(report.leave_one_out[3].line, data.surge->rows[3].line);
  EXPECT_NEAR(report.leave_one_out[3].values[1], *refit->model[ParameterId::kSurgeBeta].value,
              1e-12);
}

TEST(Profiles, AreTheCurvaturesIntervalForAlmostExactRunsAndCoverTheTruth) {
  // With small noise the model is nearly linear over the interval, so the intervals from the
  // profile likelihood and from the curvature differ only by second-order terms.
  const TrialData data = runs_on({.alpha = 1.3157, .beta = 0.8841}, 0.0, 1e-4, 5);
  IdentifyOptions options;
  options.method = Method::kNonlinear;
  const auto result = identify(vehicle(), data, options, {});
  ASSERT_TRUE(result);
  int compared = 0;
  for (const EstimatorReport& report : result->model.record.reports) {
    for (const EstimatorParameter& p : report.parameters) {
      if (!p.profile95 || report.family != "power") continue;
      const double width = p.ci95->hi - p.ci95->lo;
      EXPECT_NEAR(p.profile95->lo, p.ci95->lo, 1e-3 * width) << p.name;
      EXPECT_NEAR(p.profile95->hi, p.ci95->hi, 1e-3 * width) << p.name;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 2);
}

TEST(Options, ThatContradictEachOtherAreRefused) {
  const TrialData data = runs_on({.alpha = 1.3157, .beta = 0.8841}, 0.0, 0.01, 5);
  IdentifyOptions options;
  options.method = Method::kLogLinear;
  options.loss = Loss::kHuber;
  EXPECT_FALSE(identify(vehicle(), data, options, {}));
  options = {};
  options.method = Method::kTrajectory;
  EXPECT_FALSE(identify(vehicle(), data, options, {}));
  options = {};
  options.joint = true;
  EXPECT_FALSE(identify(vehicle(), data, options, {}));
}

/// Points on a convex curve, to be fitted by `family`. A power law whose exponent may be at most 1
/// fits them best at this bound.
SteadyProblem steeper_than_its_range(Family family) {
  SteadyProblem problem;
  problem.family = family;
  problem.beta_range = {0.0, 1.0};
  for (int i = 1; i <= 40; ++i) {
    const double speed = 0.1 * i;
    const double force = 0.05 * std::pow(speed, 1.4) * (1.0 + 0.02 * std::sin(7.0 * i));
    problem.points.push_back({.force = force, .rate = speed, .travel = {}, .elapsed_s = {}});
  }
  return problem;
}

TEST(Bounds, AFitAtTheEndOfARangeIsTheBestOfTheRemainingCoordinates) {
  // With the exponent at its bound 1, the curve is f = alpha w with alpha = sum(f w)/sum(w^2).
  const SteadyProblem problem = steeper_than_its_range(Family::kPower);
  double force_rate = 0.0;
  double rate_squared = 0.0;
  for (const SteadyPoint& point : problem.points) {
    force_rate += point.force * point.rate;
    rate_squared += point.rate * point.rate;
  }
  const SteadyFit fit = fit_steady(problem, {std::log(0.5), 0.4, 0.0, 0.0, 0.0});
  EXPECT_TRUE(fit.usable) << fit.stop_reason;
  EXPECT_EQ(fit[TransformedParameter::kBeta], 1.0);
  EXPECT_TRUE(fit.held_by_bound(TransformedParameter::kBeta));
  EXPECT_NEAR(fit.law().alpha, force_rate / rate_squared, 1e-13);
}

TEST(Bounds, ATermThatStartsAtItsBoundLeavesItWhereTheCostFallsInwards) {
  // A power law with an exponent of at most 1 does not fit convex points, but a straight line with
  // a square term does. The coefficient q of that term starts at its bound 0 and increases.
  const SteadyFit fit = fit_steady(steeper_than_its_range(Family::kCoulombLinearQuadratic),
                                   {std::log(0.05), 1.0, 0.0, 0.0, 0.0});
  EXPECT_TRUE(fit.usable) << fit.stop_reason;
  EXPECT_GT(fit[TransformedParameter::kQuadratic], 0.0);
}

TEST(Tables, FourRowsGiveThePowerLawForEveryRequestedFamily) {
  TrialData data = runs_on({.alpha = 1.2, .beta = 0.8}, 0.0, 0.01, 4);
  data.surge->rows.resize(4);
  for (const bool by_aicc : {false, true}) {
    IdentifyOptions options;
    options.method = Method::kNonlinear;
    if (by_aicc) options.surge_family = {.family = std::nullopt, .requested = true};
    const auto result = identify(vehicle(), data, options, {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->refused.empty());
    const Estimate& alpha = result->model[ParameterId::kSurgeAlpha];
    ASSERT_TRUE(alpha.ci95 && alpha.std_error);
    EXPECT_TRUE(alpha.ci95->contains(1.2));
    // Student's t with two degrees of freedom is 4.303, on either side.
    EXPECT_GT(alpha.ci95->hi - alpha.ci95->lo, 8.0 * *alpha.std_error);
    const Finding* reported = finding(result->model, "families-not-compared");
    EXPECT_EQ(reported != nullptr, by_aicc);
  }
}

TEST(Tables, SubtractsTheDeadZoneFromEachSidesCommand) {
  TurningRow row;
  row.tau_turn_m = 0.4;
  row.yaw_rate_radps = 0.5;
  const auto moment = [&](double left, double right) {
    row.sides = SideForces<double>{left, right};
    const auto points = turning_points({row}, 0.05);
    return points.empty() ? 0.0 : points[0].force;
  };
  EXPECT_DOUBLE_EQ(moment(-0.1, 0.3), 0.4 * 0.3 / 0.4);  // forces: -0.05 and 0.25
  EXPECT_DOUBLE_EQ(moment(0.1, 0.3), 0.4);               // 0.05 and 0.25: the difference is kept
  EXPECT_DOUBLE_EQ(moment(0.0, 0.2), 0.4 * 0.15 / 0.2);  // 0 and 0.15
  EXPECT_EQ(moment(-0.04, 0.04), 0.0);                   // both commands are in the dead zone
}

}  // namespace
}  // namespace awmr::testing
