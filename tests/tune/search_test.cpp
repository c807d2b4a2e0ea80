#include "awmr/tune/search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/feasible_gains.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/steering_rate.h"
#include "awmr/tune/tune_findings.h"
#include "awmr/tune/tuning_context.h"
#include "awmr/tune/tuning_steps.h"
#include "awmr/tune/turning.h"
#include "awmr/tune/unsettled_cause.h"
#include "support/uncertain_model.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

/// Options of a short search, whose gains are good enough for the tests.
TuneOptions short_options() {
  TuneOptions options;
  options.nominal = true;
  options.one_set = true;
  options.global_evaluations = 80;
  options.local_evaluations = 30;
  Scenario scenario = default_tuning_scenario(paper_model()).value();
  scenario.duration_s = 10.0;
  scenario.guidance = HeadingSteps{{{0.0, radians(30.0)}, {5.0, radians(-30.0)}}};
  options.scenarios = {scenario};
  return options;
}

const ConstraintReport& named(const Tuning& tuning, const std::string& name) {
  for (const ConstraintReport& c : tuning.constraints) {
    if (c.name == name) return c;
  }
  ADD_FAILURE() << "no constraint named " << name;
  return tuning.constraints.front();
}

std::string text_of(const TuneOptions& options) {
  const Result<Tuning> tuning = tune(paper_model(), options);
  if (!tuning) return to_text(tuning.error());
  return gains_text(*tuning, options, {.command = "tune", .options = {}, .inputs = {}});
}

/// The documented objective, implemented independently: the weighted geometric mean of the metrics
/// relative to the baseline's, floors 0.05 s, 0.1 deg s^2, 0.5 deg, 0.01/s, 0.001, 0.001 m s.
double mode_objective(const TuneOptions& options, const Gains<double>& gains, YawMode mode,
                      const Gains<double>& baseline) {
  const Model model = paper_model();
  const Plant<double> plant = model.plant().value();
  const auto figures = [&](const Gains<double>& g) {
    const Controller<double> c = make_controller(plant, model.vehicle, g);
    const Run run = simulate(plant, c, options.scenarios.front(), mode,
                             {.sample_time_s = 0.01, .substeps = {}});
    const Metrics m = metrics_of(run, options.scenarios.front(), c);
    double speed = 0.0;
    for (std::size_t i = 1; i < run.rows.size(); ++i) {
      const auto at = [&](std::size_t k) {
        return run.rows[k].t_s * std::abs(run.rows[k].u_ref_mps - run.rows[k].state.u_mps);
      };
      speed += 0.5 * (at(i) + at(i - 1)) * (run.rows[i].t_s - run.rows[i - 1].t_s);
    }
    const double settling_s = m.settling_time_s.value_or(
        unsettled_s(options.scenarios.front(), m.heading_itae_degs2.value_or(0.0)));
    return std::array<double, 6>{settling_s + 0.05,
                                 m.heading_itae_degs2.value() + 0.1,
                                 m.overshoot_deg.value() + 0.5,
                                 m.control_variation + 0.01,
                                 m.control_effort + 1e-3,
                                 speed + 1e-3};
  };
  const auto x = figures(gains);
  const auto x0 = figures(baseline);
  const ObjectiveWeights& w = options.weights;
  const double weights[] = {w.settling,          w.itae,   w.overshoot,
                            w.control_variation, w.effort, w.speed_itae};
  double sum = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += weights[i] * std::log(x[i] / x0[i]);
    total += weights[i];
  }
  return std::exp(sum / total);
}

/// The geometric mean over the modes.
double mean_objective(const TuneOptions& options, const Gains<double>& gains,
                      const Gains<double>& baseline) {
  double product = 1.0;
  for (const YawMode mode : kYawModes) product *= mode_objective(options, gains, mode, baseline);
  return std::cbrt(product);
}

TEST(History, IsTheBestSoFarOfTheSearchAndEndsWithTheGainsThatItFound) {
  const TuneOptions options = short_options();
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  // After the search, mu and mu_s were reduced as far as the objective permits, so the final
  // objective may be larger by the factor 1 + kIndifferent.
  const double found = tuning->history.best.back().objective;
  EXPECT_NEAR(tuning->objective, found, kIndifferent * found);
  EXPECT_EQ(tuning->history.evaluations, tuning->evaluations);
  const SearchHistory& history = tuning->history;
  ASSERT_FALSE(history.best.empty());
  EXPECT_LE(history.best.size(), kMaxHistorySteps);
  EXPECT_GT(history.global_evaluations, 0);
  EXPECT_LE(history.global_evaluations, history.evaluations);
  // The search starts from pole placement with wide boundary layers, which scores no worse than the
  // baseline, 1.
  EXPECT_EQ(history.best.front().evaluation, 1);
  EXPECT_LE(history.best.front().objective, 1.0);
  int evaluation = 0;
  double objective = 2.0;
  for (const SearchStep& step : history.best) {
    EXPECT_GT(step.evaluation, evaluation);
    EXPECT_LT(step.objective, objective);
    evaluation = step.evaluation;
    objective = step.objective;
  }
  EXPECT_LE(evaluation, history.evaluations);
}

TEST(Ranking, NoInfeasibleCandidateBeatsAFeasibleOne) {
  const Candidate feasible{.violation = -0.1, .objective = 5.0, .simulated = true, .valid = true};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Candidate others[] = {
      {.violation = 0.01, .objective = 0.1, .simulated = true, .valid = true},
      {.violation = -1.0, .objective = 0.1, .simulated = true, .valid = false},
      {.violation = -1.0, .objective = 0.0, .simulated = false, .valid = false},
      {.violation = nan, .objective = 0.1, .simulated = true, .valid = true},
      {.violation = -1.0, .objective = nan, .simulated = true, .valid = false},
  };
  for (const Candidate& other : others) {
    EXPECT_TRUE(better(feasible, other));
    EXPECT_FALSE(better(other, feasible));
  }
}

TEST(Ranking, OrdersFeasibleOnesByObjectiveAndOthersByViolation) {
  const Candidate good{.violation = -0.1, .objective = 0.5, .simulated = true, .valid = true};
  const Candidate fair{.violation = -0.9, .objective = 0.6, .simulated = true, .valid = true};
  const Candidate near{.violation = 0.1, .objective = 0.9, .simulated = true, .valid = true};
  const Candidate far{.violation = 0.2, .objective = 0.1, .simulated = true, .valid = true};
  EXPECT_TRUE(better(good, fair));
  EXPECT_FALSE(better(fair, good));
  EXPECT_TRUE(better(near, far));
  EXPECT_FALSE(better(far, near));
}

TEST(Objective, IsExactlyOneForTheBaselineInEveryModeAndScenario) {
  const Model model = paper_model();
  const Objective objective({.vehicles = {{model.plant().value(), model.vehicle.wheel_force}},
                             .vehicle = model.vehicle,
                             .weights = {},
                             .scenarios = short_options().scenarios},
                            kPaperGains);
  for (const Evaluation& e : {objective.baseline(), objective(kPaperGains)}) {
    EXPECT_TRUE(e.valid);
    EXPECT_EQ(e.objective, 1.0);
    for (const ModeScore& score : e.scores) EXPECT_EQ(score.objective, 1.0);
  }
}

class Tuned : public ::testing::TestWithParam<ReachingForm> {};

TEST_P(Tuned, MeetsEveryConstraintAndBeatsPolePlacementWhenSimulatedAgain) {
  TuneOptions options = short_options();
  options.form = GetParam();
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  const HeadingGains<double>& g = tuning->gains.heading;
  const double reaching_s =
      options.form == ReachingForm::kStrict ? g.epsilon / g.mu : g.epsilon / (2.0 * g.mu);
  // Tolerance: the same quotients in another order, with one or two roundings.
  EXPECT_LE(reaching_s, options.margin / g.lambda * (1.0 + 1e-14));
  for (const ConstraintReport& c : tuning->constraints) {
    if (!c.required) continue;
    EXPECT_GE(c.margin, 0.0) << c.name;
  }
  const double mean = mean_objective(options, tuning->gains, tuning->baseline.gains.common());
  EXPECT_LT(mean, 1.0);
  // Tolerance: the same metrics, summed in another order.
  EXPECT_NEAR(tuning->objective, mean, 1e-12);
  EXPECT_EQ(tuning->baseline_objective, 1.0);
  EXPECT_EQ(tuning->held_out_scores.size(), std::size(kYawModes));
}

INSTANTIATE_TEST_SUITE_P(InBothForms, Tuned,
                         ::testing::Values(ReachingForm::kPaper, ReachingForm::kStrict));

TEST(Tune, GivesTheSameBytesForTheSameSeed) {
  const TuneOptions options = short_options();
  const std::string first = text_of(options);
  EXPECT_EQ(first, text_of(options));
  EXPECT_THAT(first, ::testing::HasSubstr("\"awmr.gains/1\""));
}

TEST(Tune, ReportsProgressUpToItsEnd) {
  TuneOptions options = short_options();
  std::vector<std::size_t> done;
  std::size_t total = 0;
  options.progress = [&](std::size_t now, std::size_t of) {
    done.push_back(now);
    total = of;
  };
  ASSERT_FALSE(text_of(options).empty());
  ASSERT_FALSE(done.empty());
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_LT(done.front(), total / 2);
  EXPECT_LE(done.back(), total);
  EXPECT_GT(done.back(), total / 4) << "the total is an upper bound of the search's length";
}

/// At the optimum, mu and epsilon can be scaled together with nearly no effect on the objective.
/// Without the rule that selects the smallest mu, the seed would determine mu.
TEST(Tune, TakesTheLeastMuThatScoresAsWell) {
  TuneOptions options = short_options();
  options.local_evaluations = 300;  // ends near the optimum, where no other mu is much better
  // Small steps: the runs stay inside the boundary layer, so only mu/epsilon matters.
  options.scenarios[0].guidance = HeadingSteps{{{0.0, radians(5.0)}, {5.0, radians(-5.0)}}};
  options.baseline = Baseline{kPaperGains, kPaperSource};
  const Tuning tuning = tune(paper_model(), options).value();
  const HeadingGains<double>& heading = tuning.gains.heading;
  EXPECT_NEAR(heading.mu, tuning.mu_as_good.lo, 1e-9 * heading.mu);
  EXPECT_NEAR(tuning.gains.speed.mu, tuning.speed_mu_as_good.lo, 1e-9 * tuning.gains.speed.mu);
  EXPECT_LT(1.1 * tuning.mu_as_good.lo, tuning.mu_as_good.hi);
  const auto with_mu = [&](double mu) {
    Gains<double> gains = tuning.gains;
    gains.heading.epsilon *= mu / gains.heading.mu;
    gains.heading.mu = mu;
    return mean_objective(options, gains, tuning.baseline.gains.common());
  };
  const double own = with_mu(heading.mu);
  EXPECT_NEAR(own, tuning.objective, 1e-9);
  for (const double share : {0.25, 0.5, 0.75}) {
    const double mu = heading.mu * std::pow(tuning.mu_as_good.hi / heading.mu, share);
    EXPECT_LT(std::abs(with_mu(mu) - own), 2.0 * kIndifferent * own) << mu;
  }
  EXPECT_GT(with_mu(0.7 * heading.mu), own);
}

TEST(Tune, NamesTheActiveConstraintAndItsCost) {
  TuneOptions options = short_options();
  options.local_evaluations = 200;
  options.weights.settling =
      0.0;  // the settling time jumps when an overshoot leaves the settling band, and this would
            // hide small changes
  options.margin = 0.15;
  const Tuning tuning = tune(paper_model(), options).value();
  const auto held = std::ranges::find(tuning.active, "T2 < T1 (strict)", &ActiveConstraint::name);
  ASSERT_NE(held, tuning.active.end());
  EXPECT_GT(held->wider_gains, 0.0);
  // Relaxing the constraint by a tenth of the larger of value and limit is the same as a margin of
  // 0.15/0.9.
  options.margin = 0.15 / 0.9;
  const Tuning wider = tune(paper_model(), options).value();
  const double objective = mean_objective(options, wider.gains, tuning.baseline.gains.common());
  EXPECT_NEAR(held->wider_gains, 1.0 - objective / tuning.objective, 0.01);
}

TEST(Tune, ReportsBothMarginsOfT2BelowT1WhicheverIsRequired) {
  TuneOptions options = short_options();
  options.global_evaluations = 20;
  options.local_evaluations = 20;
  options.form = ReachingForm::kPaper;
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_NEAR(named(*tuning, "T2 < T1 (strict)").value,
              2.0 * named(*tuning, "T2 < T1 (paper)").value, 1e-12);
  EXPECT_FALSE(named(*tuning, "T2 < T1 (strict)").required);
}

TEST(Tune, RefusesAMarginThatNoGainsWithinTheBoundsMeet) {
  // eps/mu <= 0.01/lambda with lambda >= 0.5: mu/eps >= 50/s. With the servo and the hold,
  // (lambda + mu/eps)(T + T_s/2) >= 1.26, but a damping ratio of 0.7 allows 0.51 at most.
  TuneOptions options = short_options();
  options.bounds.lambda = Interval{0.5, 15.0};
  options.margin = 0.01;
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kRefused);
  EXPECT_THAT(to_text(tuning.error()), ::testing::HasSubstr("no gains within the bounds"));
}

TEST(Tune, RefusesBoundsThatExcludeEveryFeasibleGain) {
  // The bounds allow mu <= 1 rad/s^2, but a constraint needs mu >= 0.2 g3(60 deg/s)/I'z = 4.9.
  TuneOptions options = short_options();
  options.bounds.mu = Interval{0.5, 1.0};
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kRefused);
  EXPECT_THAT(to_text(tuning.error()), ::testing::HasSubstr("mu dominates"));
}

TEST(Tune, TakesGainsThatAreWorseThanTheBaseline) {
  // The bounds allow only the paper's gains. They meet every limit, and gains worse than the
  // baseline are accepted.
  TuneOptions options = short_options();
  options.bounds = {.lambda = Interval{3.0, 3.0},
                    .mu = Interval{50.0, 50.0},
                    .epsilon = Interval{12.0, 12.0},
                    .speed_mu = Interval{5.0, 5.0},
                    .speed_epsilon = Interval{1.2, 1.2}};
  options.global_evaluations = 5;
  options.local_evaluations = 5;
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_NEAR(tuning->gains.heading.epsilon, 12.0, 1e-12);
  EXPECT_GT(tuning->objective, 1.0);
}

TEST(Tune, NormalisesByTheBaselineThatIsGiven) {
  TuneOptions options = short_options();
  options.baseline = Baseline{kPaperGains, kPaperSource};
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_EQ(tuning->baseline.source, kPaperSource);
  EXPECT_EQ(tuning->baseline_objective, 1.0);
  EXPECT_NEAR(tuning->objective, mean_objective(options, tuning->gains, kPaperGains), 1e-9);
}

TEST(Tune, NamesALimitThatNoGainsKeep) {
  TuneOptions options = short_options();
  options.limits.steering_rate_rms_degps = 1.0;
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kRefused);
  EXPECT_THAT(to_text(tuning.error()), ::testing::HasSubstr("steering_rate_rms_degps"));
}

TEST(Tune, MeetsTheRequestedActivityLimit) {
  TuneOptions options = short_options();
  options.baseline = Baseline{kPaperGains, kPaperSource};
  options.activity_max = 1.5;
  options.local_evaluations = 200;
  const Result<Tuning> found = tune(paper_model(), options);
  ASSERT_TRUE(found) << to_text(found.error());
  const Tuning& tuning = *found;
  const auto activity = [&](const std::vector<ModeScore>& scores, YawMode mode) {
    double sum = 0.0;
    for (const ModeScore& score : scores) {
      if (score.mode == mode) sum += score.metrics.control_variation;
    }
    return sum;
  };
  for (const YawMode mode : kYawModes) {
    EXPECT_LE(activity(tuning.scores, mode),
              1.5 * activity(tuning.baseline_scores, mode) * (1 + 1e-12))
        << name_of(mode);
  }
}

TEST(DefaultScenario, IsThePapersForThePapersVehicle) {
  const Scenario scenario = default_tuning_scenario(paper_model()).value();
  EXPECT_EQ(scenario.name, "heading_30_-30");
  EXPECT_EQ(scenario.speed_mps, 1.0);
  EXPECT_EQ(scenario.duration_s, 20.0);
  const auto& steps = std::get<HeadingSteps>(scenario.guidance).steps;
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[1].t_s, 10.0);
  EXPECT_DOUBLE_EQ(steps[0].psi_rad, radians(30.0));
  EXPECT_DOUBLE_EQ(steps[1].psi_rad, radians(-30.0));
  const Scenario held_out = held_out_scenario(paper_model()).value();
  EXPECT_EQ(held_out.speed_mps, 0.7);
  EXPECT_DOUBLE_EQ(std::get<HeadingSteps>(held_out.guidance).steps[0].psi_rad, radians(60.0));
}

TEST(DefaultScenario, IsNoFasterThanTheVehicleReachesAndWasMeasured) {
  // With g1 = 5 u, the largest thrust of 4 holds 0.8 m/s; a third of it gives 0.27 m/s.
  Model model = paper_model();
  model[ParameterId::kSurgeAlpha].value = 5.0;
  model[ParameterId::kSurgeBeta].value = 1.0;
  EXPECT_NEAR(default_tuning_scenario(model)->speed_mps, 0.8 / 3.0, 0.005);
  model.record.trials.push_back({.kind = TrialKind::kSurge,
                                 .file = "",
                                 .line = 0,
                                 .input = 0.5,
                                 .measured = 0.1,
                                 .predicted = {}});
  EXPECT_NEAR(default_tuning_scenario(model)->speed_mps, 0.06, 1e-12);
}

TEST(DefaultScenario, TurnsLessWhereTheVehicleTurnsSlowly) {
  Model model = paper_model();
  model.vehicle.yaw_rate_max_degps = 2.0;  // deg/s: a step of 60 deg takes 30 s
  const Scenario scenario = default_tuning_scenario(model).value();
  const auto& steps = std::get<HeadingSteps>(scenario.guidance).steps;
  EXPECT_LT(steps[0].psi_rad, radians(15.5));
  EXPECT_GE(scenario.duration_s, 2.0 * 2.0 * degrees(steps[0].psi_rad) / 2.0);
  EXPECT_LE(scenario.duration_s, 40.0);
}

TEST(DefaultScenario, TurnsLessUnderASlowLimitOfTheHeadingRate) {
  const TuneOptions options;
  const auto steps_at = [&](const HeadingRateChoice& choice) {
    const auto scenarios = default_tuning_scenarios(paper_model(), options, choice).value();
    return std::get<HeadingSteps>(scenarios.front().guidance).steps;
  };
  const auto slow = steps_at("2");
  EXPECT_LT(slow[0].psi_rad, radians(15.5));
  EXPECT_GE(slow[1].t_s, 2.0 * degrees(slow[0].psi_rad) / 2.0);
  EXPECT_EQ(steps_at("none")[1].t_s, steps_at("1000")[1].t_s);
}

TEST(Tune, NamesAllUnfitOptionsAtOnce) {
  TuneOptions options = short_options();
  options.margin = 1.0;
  options.weights = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  options.bounds.lambda = Interval{-1.0, 2.0};
  options.scenarios.push_back(options.scenarios.front());
  options.scenarios.push_back(options.scenarios.front());
  options.scenarios.back().name = "open";
  options.scenarios.back().guidance = OpenLoop{};
  options.scenarios.back().control.lqi = {1.0, 1.0, 1.0, 1.0};
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kInput);
  EXPECT_EQ(tuning.error().faults.size(), 6U) << to_text(tuning.error());
}

TEST(Tune, RefusesAScenarioWithConstantThrust) {
  TuneOptions options = short_options();
  std::get<HeadingSteps>(options.scenarios.front().guidance).tau_speed = 1.4;
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kInput);
  EXPECT_EQ(tuning.error().faults.size(), 1U) << to_text(tuning.error());
}

TEST(Tune, RefusesAMillionEvaluationsOfLongScenarios) {
  TuneOptions options = short_options();
  options.global_evaluations = 1'000'000;
  options.scenarios.front().duration_s = 2000.0;
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kInput);
  EXPECT_THAT(to_text(tuning.error()), ::testing::HasSubstr("[too-large]"));
}

TEST(Tune, ReportsAMissingParameterOfTheModel) {
  Model model = paper_model();
  model[ParameterId::kMassNorm].value.reset();
  const Result<Tuning> tuning = tune(model, short_options());
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kInput);
}

TEST(MeanAndTail, IsTheMeanOfAllAndOfTheWorst) {
  EXPECT_EQ(mean_and_tail({3.0}, 0.2), 3.0);
  // Half of the mean plus half of the mean of the worst fifth. Of five values, the worst fifth is
  // the 10: (4 + 10)/2. Of six values, it is the two worst: (10 + 5)/2.
  EXPECT_EQ(mean_and_tail({1.0, 10.0, 2.0, 3.0, 4.0}, 0.2), 7.0);
  EXPECT_EQ(mean_and_tail({1.0, 10.0, 2.0, 3.0, 3.0, 5.0}, 0.2), 0.5 * (4.0 + 7.5));
  EXPECT_EQ(mean_and_tail({1.0, 3.0}, 1.0), 2.0);
}

TEST(Conditions, AreThoseOfTheVehicleOrTheDefaults) {
  Vehicle vehicle = paper_vehicle();
  EXPECT_EQ(conditions_of(vehicle).heading_noise_deg, 1.0);
  vehicle.sensors = {.heading_deg = 0.3, .speed_latency_s = 0.05};
  vehicle.motor_time_constant_s = 0.0;
  const LoopConditions c = conditions_of(vehicle);
  EXPECT_EQ(c.heading_noise_deg, 0.3);
  EXPECT_EQ(c.speed_latency_s, 0.05);
  EXPECT_EQ(c.heading_latency_s, LoopConditions{}.heading_latency_s);
  EXPECT_EQ(c.motor_time_constant_s, 0.0);
  const Scenario under_them = under(c, default_tuning_scenario(paper_model()).value());
  EXPECT_DOUBLE_EQ(under_them.sensors->heading.noise, radians(0.3));
  EXPECT_EQ(under_them.sensors->speed.latency_s, 0.05);
  // Sensors that the scenario defines itself are kept.
  Scenario own = default_tuning_scenario(paper_model()).value();
  own.sensors = Sensors{};
  EXPECT_EQ(under(c, own).sensors->heading.noise, 0.0);
}

TEST(Conditions, OfTheVehicleEquipAScenarioWithoutItsOwn) {
  const Scenario plain = default_tuning_scenario(paper_model()).value();
  Vehicle vehicle = paper_vehicle();
  EXPECT_FALSE(equipped(vehicle, plain).sensors);
  EXPECT_FALSE(equipped(vehicle, plain).actuators);
  EXPECT_EQ(equipment_text(vehicle, {&plain, 1}), "");
  vehicle.sensors = {.heading_deg = 7.0, .speed_latency_s = 0.05, .heading_correlation_s = 0.4};
  vehicle.motor_time_constant_s = 0.1;
  const Scenario with = equipped(vehicle, plain);
  EXPECT_DOUBLE_EQ(with.sensors->heading.noise, radians(7.0));
  EXPECT_EQ(with.sensors->heading.correlation_s, 0.4);
  EXPECT_THAT(equipment_text(vehicle, {&plain, 1}),
              ::testing::HasSubstr("heading: noise 7 deg, no latency; yaw rate: no noise, no "
                                   "latency; speed: no noise, latency 0.05 s"));
  EXPECT_EQ(with.sensors->speed.latency_s, 0.05);
  // Where vehicle.json gives nothing, the sensors are exact, unlike those of
  // conditions_of(vehicle).
  EXPECT_EQ(with.sensors->heading.latency_s, 0.0);
  EXPECT_EQ(with.sensors->yaw_rate.noise, 0.0);
  EXPECT_EQ(with.actuators->motor_time_constant_s, 0.1);
  // The scenario's own sensors and actuators are kept, each apart.
  Scenario own = plain;
  own.sensors = Sensors{};
  EXPECT_EQ(equipped(vehicle, own).sensors->heading.noise, 0.0);
  EXPECT_EQ(equipped(vehicle, own).actuators->motor_time_constant_s, 0.1);
  // In open loop, nothing uses the sensors, but the motors still have their lag.
  const Scenario open{.name = "open", .duration_s = 1.0, .guidance = OpenLoop{1.0, 0.0}};
  EXPECT_FALSE(equipped(vehicle, open).sensors);
  EXPECT_EQ(equipped(vehicle, open).actuators->motor_time_constant_s, 0.1);
}

TEST(Robust, BeatsThePapersGainsOnFreshDraws) {
  TuneOptions options = short_options();
  options.nominal = false;
  options.draws = 3;
  options.evaluation_draws = 40;
  options.local_evaluations = 120;  // longer: four vehicles have to meet the constraints
  const Model model = uncertain_model();
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  ASSERT_TRUE(tuning->robust);
  EXPECT_FALSE(tuning->observer_added);
  EXPECT_TRUE(tuning->robust->from_covariance);
  ASSERT_EQ(tuning->robust->evaluated.size(), 3U * std::size(kYawModes));
  const auto figure = [&](const std::string& gains, YawMode mode, const std::string& name) {
    for (const EvaluatedGains& evaluated : tuning->robust->evaluated) {
      if (evaluated.gains != gains || evaluated.mode != mode) continue;
      for (const EvaluatedFigure& f : evaluated.figures) {
        if (f.name == name) return f;
      }
    }
    ADD_FAILURE() << gains << " " << name;
    return EvaluatedFigure{};
  };
  for (const YawMode mode : kYawModes) {
    const EvaluatedFigure iae = figure("robust", mode, "heading_iae_degs");
    EXPECT_LT(iae.q95, figure("paper", mode, "heading_iae_degs").q95) << name_of(mode);
    EXPECT_LE(iae.median, iae.q95);
    // While a heading is held, the limit is 90 % of the servo's rate limit; heading steps add to
    // the RMS rate.
    EXPECT_LE(figure("robust", mode, "steering_rate_rms_degps").median, 300.0);
  }
  // Each constraint holds for the model's own plant and for each draw.
  for (const ConstraintReport& c : tuning->constraints) {
    if (!c.required) continue;
    EXPECT_GE(c.margin, 0.0) << c.name;
  }
}

/// Heading error, deg, and speed error, m/s, at the end of a run with a disturbance.
std::pair<double, double> left_by_a_push(const Scenario& pushed, const Gains<double>& gains) {
  const Run run = simulate(paper_model(), gains, pushed, YawMode::kCombined).value();
  const RunRow& last = run.rows.back();
  return {degrees(last.psi_ref_rad - last.state.psi_rad), last.u_ref_mps - last.state.u_mps};
}

TEST(Observed, AnObserverCompensatesAConstantDisturbance) {
  TuneOptions options;
  options.nominal = true;
  options.one_set = true;
  options.global_evaluations = 80;
  options.local_evaluations = 60;
  options.observer.emplace();
  const std::vector<Scenario> scenarios = default_tuning_scenarios(paper_model(), options).value();
  ASSERT_EQ(scenarios.size(), 2U);
  EXPECT_FALSE(scenarios.front().disturbance.any());
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  const ObserverGains<double>& observer = tuning->gains.observer;
  EXPECT_TRUE(options.observer->bandwidth_radps.contains(observer.bandwidth_radps));
  // Half of the moment l_f g1(1 m/s) tan(10 deg), and half of the force that four wheels at F_max
  // have left at 1 m/s.
  EXPECT_NEAR(observer.yaw_max_m, 0.5 * 0.35 * 1.3268 * std::tan(radians(10.0)), 1e-12);
  EXPECT_NEAR(observer.surge_max, 0.5 * (4.0 - 1.3268), 1e-12);
  EXPECT_FALSE(tuning->baseline.gains.common().observer.is_on());
  for (const ConstraintReport& c : tuning->constraints) {
    EXPECT_TRUE(!c.required || c.margin >= 0.0) << c.name;
  }
  const auto [heading, speed] = left_by_a_push(scenarios.back(), tuning->gains);
  const auto [heading_before, speed_before] = left_by_a_push(scenarios.back(), kPaperGains);
  EXPECT_GT(std::abs(heading_before), 2.0);
  EXPECT_GT(std::abs(speed_before), 0.1);
  EXPECT_LT(std::abs(heading), 0.02);
  EXPECT_LT(std::abs(speed), 1e-3);

  options.observer->yaw_max_m = 0.02;
  options.observer->bandwidth_radps = {3.0, 3.0};
  options.global_evaluations = 20;
  options.local_evaluations = 10;
  const Result<Tuning> held = tune(paper_model(), options);
  ASSERT_TRUE(held) << to_text(held.error());
  EXPECT_DOUBLE_EQ(held->gains.observer.bandwidth_radps, 3.0);
  EXPECT_EQ(held->gains.observer.yaw_max_m, 0.02);
}

TEST(Observed, IsComparedWithTheSameGainsWithoutObserver) {
  TuneOptions options;
  options.draws = 1;
  options.evaluation_draws = 10;
  options.one_set = true;
  options.global_evaluations = 60;
  options.local_evaluations = 20;
  options.observer.emplace();
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  std::map<std::string, double> settled;
  for (const EvaluatedGains& evaluated : tuning->robust->evaluated) {
    if (evaluated.mode == YawMode::kDifferential)
      settled[evaluated.gains] = evaluated.completed_share;
  }
  EXPECT_EQ(settled.at("robust"), 1.0);
  EXPECT_LE(settled.at("unobserved"), 0.5);  // runs with the disturbance never settle
  EXPECT_LE(settled.at("baseline"), 0.5);
}

TEST(Observed, NamesOptionsThatContradictAnObserver) {
  TuneOptions options = short_options();
  options.observer.emplace();
  options.observer->bandwidth_radps = {0.0, 3.0};
  options.observer->surge_max = -1.0;
  options.scenarios.front().control.observer = {
      .bandwidth_radps = 5.0, .yaw_max_m = 0.1, .surge_max = 0.5};
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  const std::string text = to_text(tuning.error());
  for (const char* words :
       {"bandwidth_radps", "surge_max: found -1", "sets a disturbance_observer"}) {
    EXPECT_THAT(text, ::testing::HasSubstr(words));
  }
}

TEST(Robust, RefusesALatencyOfManySamples) {
  TuneOptions options = short_options();
  options.nominal = false;
  options.evaluation_draws = 0;
  Model model = paper_model();
  model.vehicle.sensors.heading_latency_s = 1.0;
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kInput);
  EXPECT_THAT(to_text(tuning.error()), ::testing::HasSubstr("100 samples"));
}

TEST(Search, ExaminesNoDrawIfNoGainsMeetTheConstraintsOnTheNominalVehicle) {
  ConstraintContext context{.plant = paper_plant(), .latency_s = 0.05};
  TuneOptions options;
  options.bounds.mu = Interval{1e-4, 1e-3};  // below 0.2 g3/I'z
  bound_around(starting_poles(context), options.bounds);
  const Candidate alone = feasible_gains(options, context, kPaperGains);
  EXPECT_GT(alone.violation, 0.0);
  DrawnVehicle drawn = context.own();
  drawn.plant.yaw.alpha *= 5.0;  // gains violate the constraint of this vehicle by more
  context.draws = {drawn};
  EXPECT_EQ(feasible_gains(options, context, kPaperGains).violation, alone.violation);
}

TEST(Search, RefusesGainsWithWhichNoRunSettles) {
  TuneOptions options = short_options();
  options.global_evaluations = 40;
  options.local_evaluations = 10;
  options.scenarios[0].guidance = HeadingSteps{{{0.0, radians(30.0)}}};
  options.scenarios[0].duration_s = 0.3;
  options.file = "tune.json";
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kRefused);
  EXPECT_EQ(tuning.error().faults.front().place, "tune.json:/scenarios");
  EXPECT_THAT(to_text(tuning.error()), ::testing::HasSubstr("no run settles"));
  // The advice contains a number. With this number, the runs of a mode settle. The vehicle has no
  // friction at rest.
  const std::string message = tuning.error().faults.front().message;
  const std::string key = "scenarios of ";
  const std::size_t place = message.find(key);
  ASSERT_NE(place, std::string::npos) << message;
  options.scenarios[0].duration_s = std::stod(message.substr(place + key.size()));
  options.mode = YawMode::kDifferential;
  options.one_set = false;
  EXPECT_TRUE(tune(paper_model(), options)) << message;
  EXPECT_THAT(message, ::testing::Not(::testing::HasSubstr("steering_rate")));
}

/// If a limit that is stricter than its default prevents a result, the message names the limit and
/// a value with which tune() succeeds.
TEST(Search, NamesTheNumberOfTheStricterLimitWithWhichRunsSettle) {
  TuneOptions options = short_options();
  options.global_evaluations = 40;
  options.local_evaluations = 10;
  options.limits.noise_share = 2e-4;  // lambda mu/epsilon is at most 0.1/s^2
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_FALSE(tuning);
  const std::string message = tuning.error().faults.front().message;
  ASSERT_THAT(message, ::testing::HasSubstr("no run settles"));
  const std::string key = "`limits/noise_share` ";
  const std::size_t place = message.find(key);
  ASSERT_NE(place, std::string::npos) << message;
  options.limits.noise_share = std::stod(message.substr(place + key.size()));
  EXPECT_LE(options.limits.noise_share, TuningLimits{}.noise_share);
  EXPECT_TRUE(tune(paper_model(), options)) << message;
}

/// With an observer, the poles of law and observer together meet the constraints.
TEST(PolePlacement, LeavesRoomForAnObserver) {
  const ConstraintContext context{.plant = paper_plant(), .latency_s = 0.02};
  const Gains<double> placed = starting_poles(context, {2.0, 0.1, 0.1})[1];
  EXPECT_EQ(placed.observer.bandwidth_radps, 2.0);
  EXPECT_LE(std::ranges::max(residuals(constraints_of(placed, context))), 0.0);
  Gains<double> too_fast = starting_poles(context)[1];
  too_fast.observer = placed.observer;
  EXPECT_GT(std::ranges::max(residuals(constraints_of(too_fast, context))), 0.0);
}

/// Runs of the paper's vehicle in differential mode.
ObjectiveSetting paper_runs() {
  const Model model = paper_model();
  return {.vehicles = {{paper_plant(), model.vehicle.wheel_force}},
          .vehicle = model.vehicle,
          .weights = {},
          .scenarios = short_options().scenarios,
          .arithmetic = batch_arithmetic().value(),
          .mode = YawMode::kDifferential};
}

/// Gains that meet the constraints on the nominal vehicle, but not on some drawn ones, are moved
/// until they meet those of all.
TEST(Search, FindsAStartThatMeetsTheConstraintsOfAllDrawnVehicles) {
  ConstraintContext context{.plant = paper_plant(), .latency_s = 0.05};
  TuneOptions options;
  const auto poles = starting_poles(context);
  bound_around(poles, options.bounds);
  for (const double factor : {0.9, 0.6, 0.4, 1.5, 0.5}) {
    DrawnVehicle drawn = context.own();
    drawn.plant.inertia_norm *= factor;
    context.draws.push_back(drawn);
  }
  ASSERT_GT(std::ranges::max(residuals(constraints_of(poles[0], context))), 0.0);
  const Candidate start = feasible_gains(options, context, poles[0]);
  EXPECT_LE(start.violation, 0.0);
  EXPECT_EQ(start.violation, std::ranges::max(residuals(constraints_of(start.gains, context))));
  EXPECT_LE(feasible_gains(options, context, start.gains, 1).violation, 0.0);
}

/// Drawn vehicles stop short of the commanded heading because of their own yaw friction, and differ
/// in their mass, too, which matters little.
TEST(Settling, NamesTheQuantityWhoseErrorKeepsRunsFromSettling) {
  ObjectiveSetting setting = paper_runs();
  const Gains<double> gains = kPaperGains;
  DrawnVehicle drawn = setting.vehicles.front();
  drawn.plant.mass_norm *= 1.1;
  setting.vehicles.resize(4, drawn);
  ASSERT_EQ(settled_share(setting, gains), 1.0);
  EXPECT_FALSE(unsettling_error(setting, gains));
  for (std::size_t i = 1; i < 4; ++i) setting.vehicles[i].plant.yaw.coulomb = 0.05;
  ASSERT_EQ(settled_share(setting, gains), 0.25);
  const std::optional<UnsettlingError> error = unsettling_error(setting, gains);
  ASSERT_TRUE(error);
  EXPECT_THAT(error->quantity, ::testing::HasSubstr("g3"));
  EXPECT_EQ(error->settled_share, 1.0);
  EXPECT_EQ(error->share_of_identified, 1.0);
  setting.vehicles[0] = setting.vehicles[1];  // the identified vehicle does not settle either
  EXPECT_FALSE(unsettling_error(setting, gains));
}

/// Slow gains do not settle in the duration of the scenario, also without noise, and with noise not
/// in a longer one either.
TEST(Settling, FindsThatNoiseAndSlowGainsTogetherKeepRunsFromSettling) {
  ObjectiveSetting setting = paper_runs();
  Gains<double> slow = starting_poles({.plant = paper_plant()})[0];
  slow.heading.lambda *= 0.1;
  slow.heading.epsilon *= 10.0;
  ASSERT_EQ(settled_share(setting, slow), 0.0);
  EXPECT_FALSE(noise_effect(setting, slow));  // only slow
  Sensors& sensors = setting.scenarios[0].sensors.emplace();
  sensors.heading.noise = radians(7.0);
  sensors.heading.correlation_s = 2.0;
  const std::optional<NoiseEffect> effect = noise_effect(setting, slow);
  ASSERT_TRUE(effect);
  EXPECT_EQ(effect->share_without, 1.0);
  EXPECT_EQ(effect->time_factor, 4.0);
  const std::optional<NoiseEffect> fast =
      noise_effect(setting, starting_poles({.plant = paper_plant()})[0]);
  ASSERT_TRUE(fast);
  EXPECT_EQ(fast->time_factor, 1.0);
}

/// Drawn vehicles have other friction than the identified one, and the compass is noisy.
TEST(Settling, FindsThatNoiseAndErrorsOfTheModelTogetherKeepRunsFromSettling) {
  ObjectiveSetting setting = paper_runs();
  Sensors& sensors = setting.scenarios[0].sensors.emplace();
  sensors.heading.noise = radians(7.0);
  sensors.heading.correlation_s = 2.0;
  DrawnVehicle drawn = setting.vehicles.front();
  drawn.plant.yaw.coulomb = 0.05;
  setting.vehicles.resize(4, drawn);
  EXPECT_FALSE(noise_effect(setting, kPaperGains));
  EXPECT_FALSE(unsettling_error(setting, kPaperGains));
  const auto effect = noise_effect_on_identified(setting, kPaperGains);
  ASSERT_TRUE(effect);
  EXPECT_TRUE(effect->is_of_identified);
  EXPECT_EQ(effect->share_without, 1.0);
  sensors.heading.noise = 0.0;  // the identified vehicle settles
  EXPECT_FALSE(noise_effect_on_identified(setting, kPaperGains));
}

TEST(Settling, ProposesChangesThatHelpAndNoObserverIfOneIsOn) {
  ObjectiveSetting setting = paper_runs();
  const Plant<double> plant = paper_plant();
  DisturbanceTerm push;
  push.value = 0.03;  // m, less than an observer may compensate
  setting.scenarios[0].disturbance.yaw = {push};
  ConstraintContext context{.plant = plant, .mode = YawMode::kDifferential};
  Gains<double> weak = starting_poles(context)[0];
  weak.heading.lambda *= 0.25;
  weak.heading.epsilon *= 4.0;
  ASSERT_LE(std::ranges::max(residuals(constraints_of(weak, context))), 0.0);
  const auto changes = SettlingSearch(context).changes(setting, weak, 1.0);
  const auto observer = std::ranges::find(changes, "/observer", &SettlingChange::pointer);
  ASSERT_NE(observer, changes.end());
  EXPECT_THAT(observer->text, ::testing::HasSubstr("rad/s"));
  weak.observer = {1e-3, 0.1, 0.1};  // an observer that is on, but too slow to let runs settle
  const auto others = SettlingSearch(context).changes(setting, weak, 1.0);
  EXPECT_EQ(std::ranges::find(others, "/observer", &SettlingChange::pointer), others.end());
}

/// The user's bounds permit only slow gains, although the constraints permit faster ones.
TEST(Settling, ProposesWiderBoundsOfTheGains) {
  const ObjectiveSetting setting = paper_runs();
  const ConstraintContext context{.plant = paper_plant(), .mode = YawMode::kDifferential};
  const Gains<double> fast = starting_poles(context)[0];
  Gains<double> slow = fast;
  slow.heading.lambda = 0.1;
  ASSERT_EQ(settled_share(setting, slow), 0.0);
  GainBounds bounds;
  bounds.lambda = {0.5 * slow.heading.lambda, slow.heading.lambda};
  const auto changes = SettlingSearch(context, bounds).changes(setting, slow, 1.0);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes.front().pointer, "/bounds");
  const std::string key = "`bounds/lambda` that contain ";
  ASSERT_TRUE(changes.front().text.starts_with(key)) << changes.front().text;
  EXPECT_NEAR(std::stod(changes.front().text.substr(key.size())), fast.heading.lambda,
              0.005 * fast.heading.lambda);  // three digits
}

/// The paper's vehicle with Coulomb friction in yaw, m.
Model with_friction(double coulomb_m) {
  Model model = paper_model();
  model[ParameterId::kYawCoulomb] = given(coulomb_m);
  return model;
}

/// Options of a short search in steering mode, with one heading step and time to settle after it.
TuneOptions one_step_options() {
  TuneOptions options = short_options();
  options.nominal = false;
  options.draws = 1;
  options.evaluation_draws = 2;
  options.global_evaluations = 10;
  options.local_evaluations = 0;
  options.one_set = false;
  options.mode = YawMode::kSteering;
  options.scenarios.front().guidance = HeadingSteps{{{0.0, radians(30.0)}}};
  return options;
}

/// The objective is a ratio to runs that do not settle.
TEST(Tune, ReportsABaselineThatNeverSettles) {
  TuneOptions options = one_step_options();
  options.mode = YawMode::kDifferential;
  const auto is_reported = [&](const Gains<double>& baseline) {
    options.baseline = Baseline{ModeGains(baseline), "before.json"};
    const Tuning tuning = tune(paper_model(), options).value();
    const std::vector<Finding> findings = tune_findings(paper_model(), options, tuning);
    return std::ranges::any_of(findings,
                               [](const Finding& f) { return f.code == "baseline-unsettled"; });
  };
  Gains<double> slow = kPaperGains;
  EXPECT_FALSE(is_reported(slow));
  slow.heading.lambda = 0.05;
  EXPECT_TRUE(is_reported(slow));
}

/// With dry friction, gains that meet the limit of the steering rate leave a heading error. Only an
/// observer removes it.
TEST(Tune, AddsAnObserverIfRunsDoNotSettleWithoutIt) {
  const Model model = with_friction(0.03);
  TuneOptions options = one_step_options();
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_TRUE(tuning->observer_added);
  EXPECT_TRUE(tuning->gains.observer.is_on());
  EXPECT_TRUE(tuning->unsettled.empty());
  const auto has = [](const std::vector<Finding>& findings, std::string_view code) {
    return std::ranges::any_of(findings, [&](const Finding& f) { return f.code == code; });
  };
  const std::vector<Finding> findings = tune_findings(model, options, *tuning);
  EXPECT_TRUE(has(findings, "observer-added"));
  EXPECT_FALSE(has(findings, "unsettled"));

  options.adds_observer = false;
  const Result<Tuning> without = tune(model, options);
  if (without) {
    EXPECT_FALSE(without->gains.observer.is_on());
    EXPECT_TRUE(has(tune_findings(model, options, *without), "unsettled"));
  } else {
    EXPECT_EQ(without.error().faults.front().code, ErrorCode::kNoGains);
    EXPECT_THAT(to_text(without.error()), ::testing::HasSubstr("observer"));
  }
}

/// An observer whose limit is below the friction cannot move a vehicle that rests. Here the
/// friction, Coulomb friction and tyre scrub, exceeds half of the largest moment. Half of the
/// moment that the friction leaves is added.
TEST(Observer, DefaultLimitExceedsTheFrictionInYaw) {
  ConstraintContext context{.plant = paper_plant()};
  context.speed_mps = 1.0;
  const double without_m = observer_limits(context).yaw_m;
  const double moment_m = turning_authority_m(context.own(), context.speed_mps);
  EXPECT_DOUBLE_EQ(without_m, kObserverShare * moment_m);
  context.plant.yaw.coulomb = 0.8 * moment_m;
  EXPECT_DOUBLE_EQ(observer_limits(context).yaw_m, 0.9 * moment_m);
  context.plant.yaw_scrub_m = 0.1 * moment_m;
  EXPECT_DOUBLE_EQ(observer_limits(context).yaw_m, 0.95 * moment_m);
  context.plant.yaw_scrub_m = 0.3 * moment_m;  // more friction than the moment of the weaker mode
  EXPECT_DOUBLE_EQ(observer_limits(context).yaw_m, 1.1 * moment_m);
}

/// An observer needs time to compensate dry friction. In differential mode, the friction width is
/// narrow, so that no observer is needed.
TEST(DefaultScenario, LastsUntilAnObserverHasCompensatedDryFriction) {
  const auto duration_s = [](const Model& model, std::optional<YawMode> mode) {
    return default_tuning_scenario(model, mode).value().duration_s;
  };
  for (const std::optional<YawMode> mode :
       {std::optional<YawMode>{}, {YawMode::kDifferential}, {YawMode::kSteering}}) {
    EXPECT_EQ(duration_s(paper_model(), mode), 20.0);
  }
  const Model model = with_friction(0.03);
  EXPECT_GT(duration_s(model, {}), duration_s(model, YawMode::kDifferential));
  EXPECT_EQ(duration_s(model, {}), duration_s(model, YawMode::kSteering));
  EXPECT_LE(duration_s(model, YawMode::kCombined), duration_s(model, YawMode::kSteering));
  TuneOptions options;
  options.mode = YawMode::kDifferential;
  EXPECT_EQ(default_tuning_scenarios(model, options).value()[0].duration_s,
            duration_s(model, options.mode));
}

/// At the error of friction_error_rad(), the moment of the heading law equals the friction: the
/// corrective term plus the fed-forward friction, both in proportion to the error.
TEST(FrictionError, BalancesTheMomentOfTheHeadingLaw) {
  Plant<double> plant = paper_plant();
  plant.yaw.coulomb = 0.03;
  Gains<double> gains{{2.0, 5.0, 0.5}, {3.0, 0.3}};
  gains.heading.friction_width_radps = 0.4;
  const double error_rad = friction_error_rad(gains, plant, YawMode::kSteering);
  const double s = gains.heading.lambda * error_rad;
  const double moment_m = plant.inertia_norm * gains.heading.mu / gains.heading.epsilon * s +
                          plant.yaw.coulomb * s / gains.heading.friction_width_radps;
  EXPECT_NEAR(moment_m, plant.yaw.coulomb, 1e-12);
  plant.yaw.coulomb = 0.0;
  EXPECT_EQ(friction_error_rad(gains, plant, YawMode::kSteering), 0.0);
}

/// With dry friction, no gains without an observer settle, so none reach a goal on settling.
TEST(Tune, AddsAnObserverIfAGoalIsMissedWithoutIt) {
  const Model model = with_friction(0.03);
  TuneOptions options = one_step_options();
  options.global_evaluations = 40;
  options.local_evaluations = 30;
  const double duration_s = options.scenarios.front().duration_s;
  options.goals = {{.at_most = {{"settling_time_s", 0.9 * duration_s}}, .mode = {}}};
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_TRUE(tuning->observer_added);
  EXPECT_TRUE(tuning->gains.observer.is_on());

  options.adds_observer = false;
  const Result<Tuning> without = tune(model, options);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().faults.front().code, ErrorCode::kNoGains);
}

TEST(Search, ReportsThatItTakesLongBeforeItBegins) {
  std::vector<std::string> notices;
  TuneOptions options = short_options();
  options.notice = [&](std::string_view text) { notices.emplace_back(text); };
  options.global_evaluations = 40;
  options.local_evaluations = 10;
  ASSERT_TRUE(tune(paper_model(), options));
  EXPECT_TRUE(notices.empty());
  options.global_evaluations = 1000000;
  options.progress = [&](std::size_t, std::size_t) { throw std::runtime_error("begun"); };
  EXPECT_THROW((void)tune(paper_model(), options), std::runtime_error);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_THAT(notices[0], ::testing::HasSubstr("s on two cores"));
}

TEST(Turning, RefusesAVehicleThatItsMotorsCannotTurnBeforeTheSearch) {
  TuneOptions options = short_options();
  options.progress = [](std::size_t, std::size_t) { FAIL() << "searched"; };
  const Result<Tuning> tuning = tune(with_friction(3.0), options);
  ASSERT_FALSE(tuning);
  EXPECT_EQ(tuning.error().kind, ErrorKind::kRefused);
  ASSERT_EQ(tuning.error().faults.size(), 3U);  // one per mode
  EXPECT_EQ(tuning.error().faults[0].place, "model.json:/vehicle/wheel_force");
  EXPECT_THAT(tuning.error().faults[0].message,
              ::testing::AllOf(::testing::HasSubstr("is 1.44 m"),  // 4 d, with F' of -1 to 1
                               ::testing::HasSubstr("at 1 deg/s is 3.01 m")));
}

TEST(Turning, NamesTheNumbersWithWhichTheSteeringTurnsTheVehicle) {
  TuneOptions options = short_options();
  options.one_set = false;
  options.mode = YawMode::kSteering;
  Model model = with_friction(0.2);
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_FALSE(tuning);
  const std::string message = tuning.error().faults.front().message;
  const auto number_after = [&](const std::string& key) {
    const std::size_t place = message.find(key);
    EXPECT_NE(place, std::string::npos) << message;
    return place == std::string::npos ? 0.0 : std::stod(message.substr(place + key.size()));
  };
  const double angle_deg = number_after("(`max_deg`) above ");
  const double speed_mps = number_after("a speed above ");
  const double given_mps = options.scenarios[0].speed_mps;
  for (const double factor : {0.98, 1.02}) {
    Model steeper = model;
    steeper.vehicle.steering_max_deg = factor * angle_deg;
    const auto turns = [](const Model& vehicle, double mps) {
      return turning_moment({*vehicle.plant(), vehicle.vehicle.wheel_force}, mps,
                            YawMode::kSteering)
          .turns();
    };
    EXPECT_EQ(turns(steeper, given_mps), factor > 1.0) << message;
    EXPECT_EQ(turns(model, factor * speed_mps), factor > 1.0) << message;
  }
}

TEST(Robust, DrawsOnlyNoiseWithoutACovariance) {
  TuneOptions options = short_options();
  options.nominal = false;
  options.draws = 2;
  options.evaluation_draws = 0;
  options.one_set = false;
  options.mode = YawMode::kCombined;
  options.global_evaluations = 40;
  options.local_evaluations = 10;
  const Result<Tuning> tuning = tune(paper_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_FALSE(tuning->robust->from_covariance);
  EXPECT_TRUE(tuning->robust->evaluated.empty());
  const std::string text =
      gains_text(*tuning, options, {.command = "tune", .options = {}, .inputs = {}});
  EXPECT_EQ(text, text_of(options));
  EXPECT_THAT(text, ::testing::HasSubstr("noise alone"));
}

/// Message of a search that finds no gains.
std::string refusal_of(const TuneOptions& options) {
  const Result<Tuning> tuning = tune(paper_model(), options);
  EXPECT_FALSE(tuning);
  return tuning ? std::string() : to_text(tuning.error());
}

TEST(Refusal, NamesTheBoundAtFaultInsteadOfTheLimitThatItViolates) {
  TuneOptions options = short_options();
  options.bounds.lambda = Interval{20.0, 30.0};
  EXPECT_THAT(refusal_of(options), ::testing::StartsWith("error: no gains"));
  options.file = "tune.json";
  const std::string message = refusal_of(options);
  EXPECT_THAT(message, ::testing::StartsWith("error: tune.json:/"));
  EXPECT_THAT(message, ::testing::HasSubstr("no-gains"));
  EXPECT_THAT(message, ::testing::HasSubstr("bounds/lambda"));
  options.bounds.lambda = std::nullopt;
  EXPECT_TRUE(tune(paper_model(), options));
}

TEST(Refusal, NamesANumberOfTheLimitWithWhichGainsExist) {
  TuneOptions options = short_options();
  options.bounds.lambda = Interval{12.0, 12.5};
  const std::string message = refusal_of(options);
  const std::string key = "`limits/noise_share` ";
  const std::size_t place = message.find(key);
  ASSERT_NE(place, std::string::npos) << message;
  options.limits.noise_share = std::stod(message.substr(place + key.size()));
  EXPECT_TRUE(tune(paper_model(), options));
  options.limits.noise_share *= 0.9;
  EXPECT_THAT(refusal_of(options), ::testing::HasSubstr("no-gains"));
}

TEST(Refusal, LimitsOfLateLoopsConflictWithANominalSearch) {
  TuneOptions options = short_options();
  options.limits.late_damping = 0.3;
  EXPECT_THAT(refusal_of(options), ::testing::HasSubstr("conflict"));
}

/// If no gains reach a goal, the nearest gains are those that meet the constraints, even if others
/// violate a constraint by less than these miss the goal.
TEST(Candidate, ThatMeetsTheConstraintsIsNearerThanOneThatDoesNot) {
  const Candidate misses_goal{
      .violation = 1.4, .simulated = true, .valid = true, .meets_constraints = true};
  const Candidate misses_more{
      .violation = 9.0, .simulated = true, .valid = true, .meets_constraints = true};
  const Candidate violates{.violation = 0.01};
  EXPECT_TRUE(better(misses_goal, violates));
  EXPECT_TRUE(better(misses_more, violates));
  EXPECT_FALSE(better(violates, misses_more));
  EXPECT_TRUE(better(misses_goal, misses_more));
}

TEST(TradeOff, KeepsTheParetoFront) {
  std::vector<FrontPoint> points;
  for (const TradeOffPoint& point :
       {TradeOffPoint{2.0, 1.0}, {1.0, 3.0}, {1.0, 2.0}, {3.0, 1.0}, {1.5, 2.5}}) {
    points.push_back({.point = point, .gains = {}});
  }
  const auto front = front_of(points);
  ASSERT_EQ(front.size(), 2U);
  EXPECT_EQ(front[0].point.settling_time_s, 1.0);
  EXPECT_EQ(front[0].point.control_variation, 2.0);
  EXPECT_EQ(front[1].point.settling_time_s, 2.0);
  EXPECT_EQ(front[1].point.control_variation, 1.0);
  EXPECT_TRUE(front_of({}).empty());
}

TEST(TradeOff, HasTheGainsThatTheTuningNames) {
  const TuneOptions options = short_options();
  const Tuning tuning = tune(paper_model(), options).value();
  ASSERT_FALSE(tuning.trade_off.front.empty());
  std::map<std::string, TradeOffPoint> named;
  for (const NamedTradeOff& one : tuning.trade_off.named) named[one.gains] = one.point;
  for (const char* name : {"tuned", "baseline", "paper", "lqi"}) EXPECT_EQ(named.count(name), 1U);
  // Without drawn vehicles, the numbers of the trade-off are means over the modes.
  double settling_s = 0.0;
  double variation = 0.0;
  for (const ModeScore& score : tuning.scores) {
    settling_s += score.metrics.settling_time_s.value_or(10.0) / 3.0;
    variation += score.metrics.control_variation / 3.0;
  }
  EXPECT_NEAR(named["tuned"].settling_time_s, settling_s, 1e-12);
  EXPECT_NEAR(named["tuned"].control_variation, variation, 1e-12);
  // The gains of each point of the front reach this point.
  const Model model = paper_model();
  for (const FrontPoint& one : tuning.trade_off.front) {
    double front_s = 0.0;
    for (const YawMode mode : kYawModes) {
      const awmr::Run run = simulate(model, one.gains, options.scenarios[0], mode).value();
      const Metrics metrics =
          metrics_of(run, options.scenarios[0], controller_for(model, one.gains).value());
      front_s += metrics.settling_time_s.value_or(10.0) / 3.0;
    }
    EXPECT_NEAR(one.point.settling_time_s, front_s, 0.03);  // of a step in each mode
  }
}

}  // namespace
}  // namespace awmr::testing
