#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/core/json/json.h"
#include "awmr/model/gains_file.h"
#include "awmr/validate/validate.h"
#include "validate/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

Model model_with_trials() {
  Model model = fitted_paper_model();
  add_paper_trials(model);
  return model;
}

Validation validated(const Model& model, double tolerance = 0.15) {
  const auto validation = validate(model, std::nullopt, {.tolerance = tolerance});
  EXPECT_TRUE(validation);
  return *validation;
}

TEST(Validate, PredictsTheTrialsAsComputedByHand) {
  const Validation v = validated(model_with_trials());
  ASSERT_EQ(v.trials.size(), 4U);
  // Expected values, computed in Python to 7 digits: (0.2/1.3157)**(1/0.8841),
  // (2/1.3157)**(1/0.8841), (0.064/0.3028)**(1/0.8250), 0.0768 * 1.66**0.1159/(0.1159 * 1.3157)
  EXPECT_NEAR(*v.trials[0].predicted, 0.1187468, 1e-7);
  EXPECT_NEAR(*v.trials[1].predicted, 1.6058891, 1e-7);
  EXPECT_NEAR(*v.trials[2].predicted, 0.1520013, 1e-7);
  EXPECT_NEAR(*v.trials[3].predicted, 0.5341109, 1e-7);
  EXPECT_EQ(v.trials[0].unit, "m/s");
  EXPECT_EQ(v.trials[2].unit, "rad/s");
  EXPECT_EQ(v.trials[3].unit, "s");
}

TEST(Validate, ThePredictionSolvesTheResistanceLaw) {
  const auto plant = fitted_paper_model().plant();
  ASSERT_TRUE(plant);
  for (const double input : {1e-3, 0.2, 1.0, 3.7}) {
    const auto u = predicted_measurement(*plant, {TrialKind::kSurge, "", 0, input, 1.0, {}});
    const auto r = predicted_measurement(*plant, {TrialKind::kTurning, "", 0, input, 1.0, {}});
    ASSERT_TRUE(u && r);
    // The predictions solve g1(u) = tau_speed and g3(r) = tau_turn. Tolerance: two powers, each
    // accurate to a few units in the last place.
    EXPECT_NEAR(plant->surge(*u), input, 1e-14 * input);
    EXPECT_NEAR(plant->yaw(*r), input, 1e-14 * input);
  }
}

TEST(Validate, GivesTheRmsByKindAndPassesWithinTheTolerance) {
  const Validation v = validated(model_with_trials());
  const double a = 0.1187468 / 0.12 - 1.0;
  const double b = 1.6058891 / 1.66 - 1.0;
  // Tolerance: predictions with seven digits determine the errors to 1e-6.
  EXPECT_NEAR(*v.surge_rms_relative_error, std::sqrt((a * a + b * b) / 2.0), 1e-6);
  EXPECT_NEAR(*v.coastdown_rms_relative_error, 1.0 - 0.5341109 / 0.573, 1e-6);
  EXPECT_TRUE(v.passed);
  const Validation strict = validated(model_with_trials(), 0.05);
  EXPECT_FALSE(strict.passed);
  EXPECT_THAT(strict.verdict, HasSubstr("does not predict"));
  EXPECT_THAT(strict.verdict, HasSubstr("coastdown 6.8 %"));
}

TEST(Validate, DoesNotPassAModelWithoutTrials) {
  const Validation v = validated(fitted_paper_model());
  EXPECT_FALSE(v.passed);
  EXPECT_FALSE(v.surge_rms_relative_error);
  EXPECT_THAT(v.verdict, HasSubstr("no trials"));
}

TEST(Validate, HasNoStopTimeForAnExponentOfOne) {
  Model model = model_with_trials();
  model[ParameterId::kSurgeBeta].value = 1.0;
  const Validation v = validated(model, 10.0);
  EXPECT_FALSE(v.trials[3].predicted);
  EXPECT_FALSE(v.passed);
  EXPECT_THAT(v.verdict, HasSubstr("no finite prediction"));
}

TEST(Validate, NamesTheMissingParameterAndItsTrial) {
  Model model = model_with_trials();
  model[ParameterId::kMassNorm].value.reset();
  const auto v = validate(model, std::nullopt, {});
  ASSERT_FALSE(v);
  EXPECT_EQ(v.error().kind, ErrorKind::kInput);
  EXPECT_THAT(to_text(v.error()), HasSubstr("model.json:/mass_norm"));
}

TEST(Validate, RefusesImpossibleTrials) {
  Model model = model_with_trials();
  model.record.trials[1].measured = 0.0;
  const auto v = validate(model, std::nullopt, {});
  ASSERT_FALSE(v);
  EXPECT_EQ(v.error().kind, ErrorKind::kInput);
  EXPECT_EQ(v.error().faults.size(), 1U);
  EXPECT_THAT(to_text(v.error()), HasSubstr("model.json:/trials/1"));
}

TEST(Validate, RefusesAToleranceThatIsNotPositive) {
  for (const double tolerance : {0.0, -0.1, std::nan("")}) {
    const auto v = validate(model_with_trials(), std::nullopt, {.tolerance = tolerance});
    ASSERT_FALSE(v);
    EXPECT_EQ(v.error().kind, ErrorKind::kInput);
  }
}

TEST(ValidationFile, HasTheKeysOfTheContract) {
  const auto v = validate(model_with_trials(), kPaperGains, {});
  ASSERT_TRUE(v);
  const Provenance provenance{"validate", {{"tolerance", "0.15"}}, {{"model.json", "abc"}}};
  const Json json = Json::parse(validation_text(*v, provenance));
  EXPECT_EQ(json["schema"], "awmr.validation/1");
  EXPECT_EQ(json["command"], "validate");
  EXPECT_EQ(json["trials"].size(), 4U);
  EXPECT_TRUE(json["logs"].is_array() && json["logs"].empty());
  EXPECT_TRUE(json["verdict"].is_string());
  for (const Json& claim : json["claims"]) {
    EXPECT_TRUE(claim["verdict"] == "reproduced" || claim["verdict"] == "not-reproduced");
    for (const char* key : {"id", "figure", "tolerance", "why"}) {
      EXPECT_FALSE(claim[key].get<std::string>().empty()) << claim["id"] << ' ' << key;
    }
  }
}

TEST(ValidationFile, IsTheSameTextEveryTime) {
  const Provenance provenance{"validate", {}, {}};
  const auto text = [&] {
    return validation_text(*validate(model_with_trials(), kPaperGains, {}), provenance);
  };
  EXPECT_EQ(text(), text());
}

TEST(ValidationTable, FitsAHundredColumns) {
  const auto v = validate(model_with_trials(), kPaperGains, {});
  ASSERT_TRUE(v);
  const std::string table = validation_table(*v);
  EXPECT_THAT(table, HasSubstr("C14"));
  for (std::size_t begin = 0; begin < table.size();) {
    const std::size_t end = table.find('\n', begin);
    ASSERT_NE(end, std::string::npos);
    EXPECT_LE(end - begin, 100U) << table.substr(begin, end - begin);
    begin = end + 1;
  }
}

}  // namespace
}  // namespace awmr::testing
