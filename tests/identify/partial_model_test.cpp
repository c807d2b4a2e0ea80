/// Models identified from surge runs and coast-downs only: planning accepts their identified
/// parameters and refuses the others by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/identify/planning/recover.h"
#include "awmr/identify/planning/suggest.h"
#include "identify/synthetic.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

RecoverOptions runs_of(RecoverPlan plan, int runs) {
  RecoverOptions options;
  options.plan = plan;
  options.runs = runs;
  return options;
}

/// Model identified from surge runs only or, if `coastdown`, from surge runs and coast-downs.
Model partial_model(bool coastdown) {
  Vehicle v = paper_vehicle();
  v.sway_alpha.reset();
  TrialData data = synthetic(kTruths[0], 0.02, 3);
  data.turning.reset();
  if (!coastdown) data.coastdown.reset();
  return identify(v, data, {}, {})->model;
}

std::vector<ParameterId> missing_of(const Suggestion& suggestion) {
  std::vector<ParameterId> ids;
  for (const MissingParameter& missing : suggestion.missing) ids.push_back(missing.id);
  return ids;
}

TEST(PartialModel, SuggestsMissingParametersFirstAndRanksStraightTrials) {
  const auto suggestion = suggest(partial_model(true), {});
  ASSERT_TRUE(suggestion) << to_text(suggestion.error());
  EXPECT_THAT(missing_of(*suggestion),
              ElementsAre(ParameterId::kYawAlpha, ParameterId::kYawBeta, ParameterId::kSwayAlpha));
  ASSERT_FALSE(suggestion->trials.empty());
  for (const SuggestedTrial& trial : suggestion->trials) {
    EXPECT_NE(trial.kind, TrialKind::kTurning);
    EXPECT_THAT(trial.settings, Not(HasSubstr("steering")));
    EXPECT_TRUE(std::isfinite(trial.std_error_after) && std::isfinite(trial.d_gain));
    EXPECT_LE(trial.std_error_after, trial.std_error_before * (1.0 + 1e-9));
  }
  const std::string sheet = field_sheet(*suggestion, 3);
  EXPECT_THAT(sheet, HasSubstr("for yaw.alpha, yaw.beta, not identified yet"));
  EXPECT_THAT(suggestion_text(*suggestion, {}), HasSubstr("\"missing\""));
}

TEST(PartialModel, WithoutAMassSuggestsSurgeRunsAndTheCoastDown) {
  const auto suggestion = suggest(partial_model(false), {});
  ASSERT_TRUE(suggestion) << to_text(suggestion.error());
  EXPECT_THAT(missing_of(*suggestion), Contains(ParameterId::kMassNorm));
  for (const SuggestedTrial& trial : suggestion->trials) EXPECT_EQ(trial.kind, TrialKind::kSurge);
}

TEST(PartialModel, RefusesToRankByAParameterWithoutValue) {
  const auto suggestion = suggest(partial_model(true), {.parameter = "yaw.alpha"});
  ASSERT_FALSE(suggestion);
  EXPECT_EQ(exit_code(suggestion.error()), 2);
  EXPECT_THAT(to_text(suggestion.error()), HasSubstr("a turning trial"));
}

TEST(PartialModel, IsRecoveredFromItsOwnTables) {
  for (const bool coastdown : {false, true}) {
    const Model model = partial_model(coastdown);
    const auto recovery = recover(model, runs_of(RecoverPlan::kTables, 40), nullptr);
    ASSERT_TRUE(recovery) << to_text(recovery.error());
    EXPECT_EQ(recovery->failed, 0);
    std::vector<std::string_view> names;
    for (const RecoveredParameter& p : recovery->parameters) {
      names.push_back(info(p.id).name);
      EXPECT_EQ(p.truth, *model[p.id].value);
      // The mean of 40 runs has a standard error of rmse/sqrt(40), four of which are practically
      // never exceeded by chance.
      EXPECT_LT(std::abs(p.bias), 4.0 * p.rmse / std::sqrt(40.0)) << names.back();
      EXPECT_GE(p.coverage95, 0.8) << names.back();
    }
    EXPECT_THAT(names, Contains("surge.alpha"));
    EXPECT_THAT(names, Not(Contains("yaw.alpha")));
    EXPECT_EQ(std::count(names.begin(), names.end(), "mass_norm"), coastdown ? 1 : 0);
  }
}

TEST(PartialModel, IsRecoveredFromAStraightLog) {
  RecoverOptions options = runs_of(RecoverPlan::kLog, 3);
  options.drive.duration_s = 30.0;
  const auto recovery = recover(partial_model(true), options, nullptr);
  ASSERT_TRUE(recovery) << to_text(recovery.error());
  EXPECT_EQ(recovery->failed, 0);
  EXPECT_EQ(recovery->parameters.size(), 3U);  // a1, b1, m'
  for (const RecoveredParameter& p : recovery->parameters) {
    EXPECT_EQ(p.runs, 3);
    EXPECT_LT(p.worst_error, 0.2) << info(p.id).name;
  }
}

TEST(PartialModel, RefusesToRecoverFromTrialsOfUnknownParameters) {
  Model model = partial_model(true);
  model.record.trials.push_back({TrialKind::kTurning, "turning.csv", 2, 0.05, 0.1, {}});
  const auto turning = recover(model, runs_of(RecoverPlan::kTables, 2), nullptr);
  ASSERT_FALSE(turning);
  EXPECT_THAT(to_text(turning.error()), HasSubstr("no value for yaw.alpha"));
  const auto curve = recover(partial_model(false), runs_of(RecoverPlan::kCurve, 2), nullptr);
  ASSERT_FALSE(curve);
  EXPECT_THAT(to_text(curve.error()), HasSubstr("no value for mass_norm"));
}

}  // namespace
}  // namespace awmr::testing
