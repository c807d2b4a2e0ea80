/// Limits that the baseline gains do not meet, and the finding about the objective above theirs.
#include "awmr/tune/tuning_steps.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "awmr/model/paper_gains.h"
#include "awmr/tune/tune_findings.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> names_of(const std::vector<ConstraintReport>& reports) {
  std::vector<std::string> names;
  for (const ConstraintReport& report : reports) names.push_back(report.name);
  return names;
}

/// Options of a short search for the steering mode of the model's own vehicle.
TuneOptions options_for(const Model& model) {
  TuneOptions options;
  options.nominal = true;
  options.mode = YawMode::kSteering;
  options.global_evaluations = 40;
  options.local_evaluations = 40;
  options.scenarios = {default_tuning_scenario(model).value()};
  return options;
}

const Finding* baseline_finding(const std::vector<Finding>& findings) {
  const auto found =
      std::ranges::find(findings, std::string("baseline-beyond-limits"), &Finding::code);
  return found == findings.end() ? nullptr : &*found;
}

TEST(BaselineLimits, AreMetByPolePlacement) {
  const Model model = paper_model();
  const TuneOptions options = options_for(model);
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_THAT(names_of(tuning->baseline_violates), IsEmpty());
  EXPECT_EQ(baseline_finding(tune_findings(model, options, *tuning)), nullptr);
}

TEST(BaselineLimits, ExplainAnObjectiveAboveThatOfTheBaseline) {
  const Model model = paper_model();
  TuneOptions options = options_for(model);
  options.bounds.lambda = {0.3, 0.6};
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_GT(tuning->objective, tuning->baseline_objective);
  ASSERT_THAT(names_of(tuning->baseline_violates), ElementsAre("bounds/lambda"));
  const ConstraintReport& lambda = tuning->baseline_violates.front();
  EXPECT_EQ(lambda.value, tuning->baseline.gains.common().heading.lambda);
  EXPECT_EQ(lambda.limit, 0.6);
  EXPECT_EQ(lambda.sense, Sense::kAtMost);
  EXPECT_EQ(lambda.margin, 0.6 - lambda.value);
  const std::vector<Finding> findings = tune_findings(model, options, *tuning);
  const Finding* finding = baseline_finding(findings);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->severity, Severity::kNote);
  EXPECT_THAT(finding->message, HasSubstr("(at most 0.6)"));
}

TEST(BaselineLimits, IncludeConstraintsActivityAndHardGoals) {
  const Model model = paper_model();
  TuneOptions options = options_for(model);
  options.activity_max = 0.7;
  const GoalLimit impossible{"control_variation", 1e-6};
  options.goals = {{.at_most = {impossible}, .mode = {}},
                   {.at_most = {impossible}, .mode = {}, .is_soft = true}};
  const Plant<double> plant = model.plant().value();
  const Objective objective(
      {.vehicles = {{plant, model.vehicle.wheel_force}, {plant, model.vehicle.wheel_force}},
       .vehicle = model.vehicle,
       .weights = {},
       .scenarios = options.scenarios,
       .arithmetic = batch_arithmetic().value(),
       .goals = options.goals,
       .mode = options.mode},
      kPaperGains);
  ConstraintContext context;
  context.plant = plant;
  context.limits.noise_share = 1e-6;
  const std::vector<ConstraintReport> all =
      violated_by_baseline(kPaperGains, objective, context, options);
  EXPECT_THAT(names_of(all),
              ElementsAre("noise gain", "activity_max", HasSubstr("control_variation")));
  EXPECT_EQ(all[1].limit, 0.7);
  EXPECT_GT(all[2].value, 1.0);
  for (const ConstraintReport& one : all) EXPECT_LT(one.margin, 0.0) << one.name;
}

}  // namespace
}  // namespace awmr::testing
