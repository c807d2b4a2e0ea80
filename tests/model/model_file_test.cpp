#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/random.h"
#include "awmr/core/units.h"
#include "awmr/model/model.h"
#include "awmr/model/model_file.h"
#include "awmr/model/ranges.h"
#include "json_edit.h"
#include "support/paper_vehicle.h"

namespace awmr::testing::model_file_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

Vehicle some_vehicle() {
  Vehicle vehicle = paper_vehicle();
  vehicle.name = "a \"vehicle\", naïve\n";
  vehicle.wheel_force = {-0.1, 0.7};
  vehicle.yaw_inertia_kgm2 = std::nullopt;
  vehicle.sway_alpha = 1.0 / 3.0;
  vehicle.surge_beta_range = {0.0, 1.5};
  vehicle.yaw_beta_range = {0.1, 4.0};
  return vehicle;
}

/// Every field is set, with doubles that have no short decimal form.
Model some_model() {
  Model model;
  model.vehicle = some_vehicle();
  for (const ParameterInfo& parameter : parameter_table()) {
    const double value = 0.1 + std::sqrt(static_cast<double>(parameter.id) + 2.0);
    model[parameter.id] = {value, value / 7.0, Interval{value / 3.0, value * 3.0}, Source::kFitted,
                           "log-linear"};
  }
  // A dead zone below the largest force, 0.7.
  model[ParameterId::kWheelDeadZone] = {1.0 / 17.0, 1.0 / 70.0, Interval{1.0 / 30.0, 1.0 / 11.0},
                                        Source::kFitted, "log-linear"};
  // Standard errors that are consistent with the covariance below.
  model[ParameterId::kSurgeAlpha].std_error = std::sqrt(1e-4);
  model[ParameterId::kSurgeBeta].std_error = std::sqrt(2.5e-4);
  model[ParameterId::kMassNorm].source = Source::kDerived;
  model[ParameterId::kSwayAlpha] = {3.0, {}, {}, Source::kGiven, "vehicle.json"};
  model.record.reports = {{.subject = FitSubject::kSurge,
                           .estimator = Estimator::kLogLinear,
                           .noise = "log force",
                           .parameters = {{"surge.alpha", 1.3157, 0.0183, Interval{1.27, 1.36}},
                                          {"surge.beta", 0.8841, {}, {}}},
                           .residual_std = 0.0364,
                           .rows_used = 10,
                           .degrees_of_freedom = 8,
                           .rank = 2,
                           .condition_number = 3.3,
                           .stop_reason = "solved directly"}};
  model.covariance = {{ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta},
                      {{1e-4, 2.0 / 3.0 * 1e-5}, {2.0 / 3.0 * 1e-5, 2.5e-4}}};
  model.record.findings = {{"surge.csv", 11, Severity::kWarning, "speed-mismatch", "1.03 and 1.08"},
                           {"", 0, Severity::kNote, "rows-set-aside", "1 row"},
                           {"t.csv", 0, Severity::kError, "not-identifiable", "no"}};
  model.record.trials = {{TrialKind::kSurge, "surge.csv", 4, 0.2, 0.12, 0.1188},
                         {TrialKind::kTurning, "t.csv", 3, 0.02, 0.038, {}},
                         {TrialKind::kCoastdown, "c.csv", 4, 1.66, 0.573, 0.55}};
  model.record.provenance = {
      "identify", {{"method", "log-linear"}}, {{"surge.csv", std::string(64, 'a')}}};
  return model;
}

Result<Model> reread(const std::string& text) {
  const ScratchFile file("model.json", text);
  return read_model(file.path());
}

std::vector<std::string> faults_after(const Edit& edit) {
  return faults_of(read_model, edited(model_text(some_model()), edit));
}

TEST(ModelFile, ExplainsFaultsOfItsVehicleAsInVehicleJson) {
  EXPECT_THAT(faults_after({"/vehicle/drive", "rear_wheel"}),
              ElementsAre(AllOf(StartsWith("/vehicle/drive: rear_wheel is not supported"),
                                HasSubstr("use differential"), Not(HasSubstr("four_wheel")))));
  EXPECT_THAT(faults_after({"/vehicle/length_m", 1320.0}),
              ElementsAre(AllOf(StartsWith("/vehicle/length_m: "), HasSubstr("looks like mm"))));
}

TEST(ModelFile, NamesTheSourceOfAMissingEstimate) {
  EXPECT_THAT(faults_after({"/surge/alpha", {}, true}),
              ElementsAre(AllOf(StartsWith("/surge/alpha: "), HasSubstr("surge trial"))));
  EXPECT_THAT(faults_after({"/steering", {}, true}),
              ElementsAre(AllOf(StartsWith("/steering: "), HasSubstr("steering_cmd_deg"))));
  // A vehicle without steering has no time constant. The value in the message is accepted.
  Model model = some_model();
  model.vehicle.drive = Drive::kDifferential;
  model[ParameterId::kSteeringTimeConstant] = {{}, {}, {}, Source::kGiven, "no steering"};
  const std::string text = model_text(model);
  const Edit gone{"/steering/time_constant_s", {}, true};
  const std::vector<std::string> faults = faults_of(read_model, edited(text, gone));
  ASSERT_THAT(faults, SizeIs(1));
  const std::size_t first = faults[0].find('{'), last = faults[0].find('}');
  ASSERT_NE(last, std::string::npos) << faults[0];
  const Json value = Json::parse(faults[0].substr(first, last + 1 - first));
  EXPECT_THAT(faults_of(read_model, edited(text, {"/steering/time_constant_s", value})),
              ::testing::IsEmpty());
}

TEST(ModelFile, OfAnotherKindIsOneFault) {
  EXPECT_THAT(faults_after({"/schema", "awmr.gains/1"}), ElementsAre(StartsWith("/schema: ")));
}

TEST(ModelFile, AStandardErrorOfZeroMeansAKnownValueWithoutVariance) {
  Model model = some_model();
  // Without an entry in the covariance, drawn plants do not vary the parameter.
  model[ParameterId::kMassNorm].std_error = 0.0;
  EXPECT_THAT(faults_of(read_model, model_text(model)), IsEmpty());
  model[ParameterId::kSurgeAlpha].std_error = 0.0;
  EXPECT_THAT(faults_of(read_model, model_text(model)), ElementsAre(StartsWith("/covariance: ")));
  model.covariance.matrix = {{0.0, 0.0}, {0.0, 2.5e-4}};
  EXPECT_THAT(faults_of(read_model, model_text(model)), IsEmpty());
}

TEST(ModelFile, GivesTheSameBytesWhenWrittenAgain) {
  const std::string text = model_text(some_model());
  const auto model = reread(text);
  ASSERT_TRUE(model) << to_text(model.error());
  EXPECT_EQ(model_text(*model), text);
}

TEST(ModelFile, ReadsBackEveryFieldExactly) {
  const Model written = some_model();
  const auto model = reread(model_text(written));
  ASSERT_TRUE(model) << to_text(model.error());
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& a = written[parameter.id];
    const Estimate& b = (*model)[parameter.id];
    EXPECT_EQ(a.value, b.value) << parameter.name;
    EXPECT_EQ(a.std_error, b.std_error) << parameter.name;
    ASSERT_EQ(a.ci95.has_value(), b.ci95.has_value()) << parameter.name;
    if (a.ci95) {
      EXPECT_EQ(a.ci95->lo, b.ci95->lo) << parameter.name;
      EXPECT_EQ(a.ci95->hi, b.ci95->hi) << parameter.name;
    }
    EXPECT_EQ(a.source, b.source) << parameter.name;
    EXPECT_EQ(a.method, b.method) << parameter.name;
  }
  EXPECT_EQ(model->vehicle.name, written.vehicle.name);
  EXPECT_EQ(model->vehicle.sway_alpha, written.vehicle.sway_alpha);
  EXPECT_FALSE(model->vehicle.yaw_inertia_kgm2);
  EXPECT_EQ(model->vehicle.surge_beta_range.hi, 1.5);
  EXPECT_EQ(model->covariance.matrix, written.covariance.matrix);
  EXPECT_EQ(model->covariance.parameters, written.covariance.parameters);
  EXPECT_EQ(model->record.findings[2].severity, Severity::kError);
  EXPECT_EQ(model->record.findings[0].line, 11);
  EXPECT_EQ(model->record.trials[0].predicted, 0.1188);
  EXPECT_FALSE(model->record.trials[1].predicted);
  EXPECT_EQ(model->record.provenance.command, "identify");
  EXPECT_EQ(model->record.provenance.inputs[0].sha256, std::string(64, 'a'));
}

TEST(ModelFile, RoundTripsArbitraryNumbersAndGaps) {
  Random random(7, 0);
  for (int i = 0; i < 200; ++i) {
    Model model = some_model();
    model.covariance = {};
    for (Estimate& estimate : model.estimates) {
      // Magnitudes over the whole accepted range (ranges.h); a third of the values is unknown.
      const auto id = static_cast<ParameterId>(&estimate - model.estimates.data());
      const bool exponent = id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
      const bool time = id == ParameterId::kSteeringTimeConstant;
      const double decades = time ? 9.0 * random.uniform() - 6.0 : 18.0 * random.uniform() - 9.0;
      const bool zone = id == ParameterId::kWheelDeadZone;
      const double value = exponent ? 20.0 * random.uniform()
                           : zone   ? 0.7 * random.uniform()
                                    : std::pow(10.0, decades);
      estimate.value = random.uniform() < 0.33 ? std::nullopt : std::optional(value);
      estimate.std_error = random.uniform() < 0.5 ? std::nullopt : std::optional(value * 0.1);
      estimate.ci95 =
          random.uniform() < 0.5 ? std::nullopt : std::optional(Interval{-value, value * 1.1});
    }
    // I'z/m' must be that of the vehicle, up to the distribution of its mass.
    Estimate& inertia = model[ParameterId::kInertiaNorm];
    if (const auto mass = model[ParameterId::kMassNorm].value; mass && inertia.value) {
      const double share = model.vehicle.inertia_kgm2() / model.vehicle.mass_kg;
      inertia.value = std::clamp(*mass * share, kCoefficient.min, kCoefficient.max);
      inertia.ci95.reset();
    }
    const std::string text = model_text(model);
    const auto back = reread(text);
    ASSERT_TRUE(back) << to_text(back.error());
    ASSERT_EQ(model_text(*back), text);
    for (std::size_t k = 0; k < kParameterCount; ++k) {
      ASSERT_EQ(back->estimates[k].value, model.estimates[k].value);
    }
  }
}

TEST(ModelFile, RoundTripsAModelWithoutValues) {
  Model model;
  model.vehicle = some_vehicle();
  model.record.provenance.command = "identify";
  const std::string text = model_text(model);
  const auto back = reread(text);
  ASSERT_TRUE(back) << to_text(back.error());
  EXPECT_EQ(model_text(*back), text);
}

TEST(ModelFile, WritesNoInfinityAndNoNaN) {
  Model model = some_model();
  model.record.reports[0].condition_number = std::numeric_limits<double>::infinity();
  model.record.reports[0].residual_std = std::numeric_limits<double>::quiet_NaN();
  model[ParameterId::kMassNorm].std_error = std::numeric_limits<double>::infinity();
  const auto back = reread(model_text(model));
  ASSERT_TRUE(back) << to_text(back.error());
  EXPECT_TRUE(std::isinf(back->record.reports[0].condition_number));
  EXPECT_TRUE(std::isnan(back->record.reports[0].residual_std));
  EXPECT_FALSE((*back)[ParameterId::kMassNorm].std_error);
  EXPECT_EQ(model_text(*back), model_text(model));
}

TEST(ModelFile, HasTheContractsKeysAndUnits) {
  const Json json = Json::parse(model_text(some_model()));
  EXPECT_EQ(json["schema"], "awmr.model/1");
  for (const ParameterInfo& parameter : parameter_table()) {
    const Json& estimate = json[Json::json_pointer(std::string(parameter.pointer))];
    std::vector<std::string> keys;
    for (const auto& item : estimate.items()) keys.push_back(item.key());
    EXPECT_THAT(keys, ElementsAre("value", "std_error", "ci95", "unit", "source", "method"));
    EXPECT_EQ(estimate["unit"], parameter.unit);
  }
  EXPECT_EQ(json["covariance"]["parameters"], Json({"surge.alpha", "surge.beta"}));
  EXPECT_EQ(json["vehicle"]["wheel_force"]["max"], 0.7);
  EXPECT_EQ(json["findings"][0]["severity"], "warning");
  EXPECT_TRUE(json.contains("inputs"));
}

TEST(ModelFile, NeedsEveryKey) {
  const Json json = Json::parse(model_text(some_model()));
  const Json flat = json.flatten();
  for (const auto& item : flat.items()) {
    const std::string& pointer = item.key();
    const std::string last = pointer.substr(pointer.rfind('/') + 1);
    const bool optional = last == "schema" || last == "sway_alpha" ||
                          pointer.find("_beta_range") != std::string::npos ||
                          pointer == "/command" || pointer == "/version" ||
                          pointer.find("/options/") == 0 ||
                          pointer.find("/si/") == 0;  // derived from other values, so not read
    const bool element = last.find_first_not_of("0123456789") == std::string::npos;
    if (optional || element) continue;
    EXPECT_THAT(faults_after({pointer, {}, true}), SizeIs(1)) << pointer;
  }
  for (const char* pointer : {"/vehicle", "/surge", "/yaw", "/mass_norm", "/estimates",
                              "/covariance", "/covariance/matrix", "/findings", "/trials"}) {
    EXPECT_THAT(faults_after({pointer, {}, true}), SizeIs(::testing::Ge(1u))) << pointer;
  }
}

TEST(ModelFile, RefusesUnknownKeysAtEveryLevel) {
  for (const char* pointer : {"/extra", "/surge/gamma", "/surge/alpha/extra", "/mass_norm/extra",
                              "/steering/extra", "/vehicle/extra", "/vehicle/steering/extra",
                              "/estimates/0/extra", "/estimates/0/parameters/1/extra",
                              "/covariance/extra", "/findings/0/extra", "/trials/2/extra"}) {
    EXPECT_THAT(faults_after({pointer, 1}), ElementsAre(StartsWith(pointer))) << pointer;
  }
}

TEST(ModelFile, RefusesImpossibleValues) {
  const std::vector<Edit> edits{{"/schema", "awmr.vehicle/1"},
                                {"/surge/alpha/value", 0},
                                {"/surge/alpha/value", "1"},
                                {"/surge/beta/value", -0.1},
                                {"/mass_norm/value", -1},
                                {"/mass_norm/std_error", -1},
                                {"/mass_norm/ci95", Json::array({2, 1})},
                                {"/mass_norm/ci95", Json::array({1})},
                                {"/mass_norm/unit", "kg"},
                                {"/mass_norm/source", "guessed"},
                                {"/mass_norm/method", 3},
                                {"/vehicle/mass_kg", 0},
                                {"/estimates/0/parameters/0/name", "surge.gamma"},
                                {"/estimates/0/rows_used", -1},
                                {"/estimates/0/rows_used", 1.5},
                                {"/covariance/parameters", {"surge.alpha", "surge.gamma"}},
                                {"/covariance/matrix", 1},
                                {"/covariance/matrix/0", {1}},
                                {"/covariance/matrix/1/1", nullptr},
                                {"/covariance/matrix/0/0", -2.5e-4},
                                {"/covariance/matrix/1/1", -2.5e-4},
                                {"/covariance/matrix/0/1", 1e-5},
                                {"/findings/0/severity", "fatal"},
                                {"/findings/0/line", -1},
                                {"/trials/0/kind", "parking"},
                                {"/trials/0/kind", "log"},
                                {"/trials/0/kind", ""},
                                {"/trials/0/input", nullptr},
                                {"/trials", Json::object()}};
  for (const Edit& edit : edits) {
    EXPECT_THAT(faults_after(edit), SizeIs(1)) << edit.pointer << " = " << edit.value.dump();
  }
  EXPECT_THAT(faults_after({"/covariance/parameters", {"surge.alpha", "surge.alpha"}}),
              ::testing::Contains(HasSubstr("twice")));
}

TEST(ModelFile, RefusesSizesThatContradictEachOtherUnlessIdentifyAcceptedThem) {
  // The vehicle of the paper: 1.32 m x 0.78 m, l_f 0.35 m, d 0.36 m, 37 kg.
  const std::vector<Edit> edits{
      {"/vehicle/half_track_m", 36.0},     // refused: 100 times the size of the vehicle
      {"/vehicle/half_track_m", 0.001},    // refused: the wheels are in the middle
      {"/vehicle/front_axle_m", 0.7},      // refused: the front axle is ahead of the body
      {"/vehicle/length_m", 90.0},         // refused: 100 times longer than wide
      {"/vehicle/mass_kg", 37000.0},       // refused: grams
      {"/vehicle/steering/max_deg", 0.35}  // refused: radians
  };
  for (const Edit& edit : edits) {
    EXPECT_THAT(faults_after(edit), ElementsAre(StartsWith(edit.pointer)))
        << edit.pointer << " = " << edit.value.dump();
    Model accepted = some_model();
    accepted.record.findings.push_back({"", 0, Severity::kWarning, "implausible-vehicle", ""});
    EXPECT_THAT(faults_of(read_model, edited(model_text(accepted), edit)), IsEmpty());
    EXPECT_THAT(faults_of(read_model_as_is, edited(model_text(some_model()), edit)), IsEmpty());
  }
}

TEST(ModelFile, RefusesQuantitiesThatTheVehicleCannotHave) {
  EXPECT_THAT(faults_after({"/wheel/dead_zone/ci95", nullptr}), IsEmpty());
  Model model = some_model();
  for (Estimate& estimate : model.estimates) estimate.ci95.reset();
  model[ParameterId::kMassNorm].value = 0.1;
  const double share = model.vehicle.inertia_kgm2() / model.vehicle.mass_kg;
  // I'z/m' must be 0.05 to 3 times Iz/m of the vehicle. For estimates without intervals, a further
  // factor of 2 is accepted at both ends.
  for (const double times : {0.03, 1.0, 5.9}) {
    model[ParameterId::kInertiaNorm].value = 0.1 * share * times;
    EXPECT_TRUE(reread(model_text(model))) << times;
  }
  for (const double times : {1e-3, 6.1, 1e4}) {
    model[ParameterId::kInertiaNorm].value = 0.1 * share * times;
    EXPECT_THAT(faults_of(read_model, model_text(model)),
                ElementsAre(StartsWith("/inertia_norm/value: ")))
        << times;
  }
  model[ParameterId::kInertiaNorm].value = 0.1 * share;
  model[ParameterId::kWheelDeadZone].value = 0.7;  // wheel_force.max
  EXPECT_THAT(faults_of(read_model, model_text(model)),
              ElementsAre(StartsWith("/wheel/dead_zone/value: ")));
}

TEST(Model, BecomesAPlantInRadians) {
  const auto plant = some_model().plant();
  ASSERT_TRUE(plant);
  const Model model = some_model();
  EXPECT_EQ(plant->surge.alpha, *model[ParameterId::kSurgeAlpha].value);
  EXPECT_EQ(plant->surge.beta, *model[ParameterId::kSurgeBeta].value);
  EXPECT_EQ(plant->surge.rest_speed, 0.0);
  EXPECT_EQ(plant->yaw.alpha, *model[ParameterId::kYawAlpha].value);
  EXPECT_EQ(plant->yaw.beta, *model[ParameterId::kYawBeta].value);
  EXPECT_EQ(plant->sway_alpha, 3.0);
  EXPECT_EQ(plant->mass_norm, *model[ParameterId::kMassNorm].value);
  EXPECT_EQ(plant->inertia_norm, *model[ParameterId::kInertiaNorm].value);
  EXPECT_EQ(plant->front_axle_m, 0.35);
  EXPECT_EQ(plant->half_track_m, 0.36);
  EXPECT_DOUBLE_EQ(plant->steering_max_rad, pi<double>() / 9.0);
  EXPECT_DOUBLE_EQ(plant->steering_max_rate_radps, pi<double>() * 300.0 / 180.0);
  EXPECT_EQ(plant->steering_time_constant_s, *model[ParameterId::kSteeringTimeConstant].value);
}

TEST(Model, RefusesAPlantByTheNameOfEachMissingParameterWithItsTrial) {
  for (const ParameterInfo& parameter : parameter_table()) {
    Model model = some_model();
    model[parameter.id].value.reset();
    const auto plant = model.plant();
    ASSERT_FALSE(plant) << parameter.name;
    EXPECT_EQ(exit_code(plant.error()), 2);
    ASSERT_THAT(plant.error().faults, SizeIs(1));
    EXPECT_EQ(plant.error().faults[0].place, "model.json:" + std::string(parameter.pointer));
    EXPECT_THAT(plant.error().faults[0].message, AllOf(HasSubstr(std::string(parameter.name)),
                                                       HasSubstr(std::string(parameter.trial))));
  }
  Model nothing;
  EXPECT_THAT(nothing.plant().error().faults, SizeIs(8));  // a power law has no other terms
}

TEST(Model, GivesAPlantForAMotionWhoseParametersAreKnown) {
  for (const Motion motion :
       {Motion::kSteadySurge, Motion::kSteadyTurn, Motion::kStraight, Motion::kPlanar}) {
    for (const ParameterInfo& parameter : parameter_table()) {
      Model model = some_model();
      model[parameter.id].value.reset();
      EXPECT_EQ(model.plant(motion).has_value(), !takes(motion, parameter.id)) << parameter.name;
      EXPECT_EQ(model.simulated_motion(), Motion::kStraight);
    }
  }
  EXPECT_EQ(some_model().simulated_motion(), Motion::kPlanar);
  // Unknown values are multiplied by zeros, so a straight motion remains straight.
  Model straight = some_model();
  for (const ParameterInfo& parameter : parameter_table()) {
    if (!takes(Motion::kStraight, parameter.id)) straight[parameter.id].value.reset();
  }
  const SideForces<double> force{0.2, 0.2};
  State<double> state{};
  state.u_mps = 0.5;
  const State<double> rates = state_rates(*straight.plant(Motion::kStraight), state, force, 0.0);
  EXPECT_EQ(rates.v_mps, 0.0);
  EXPECT_EQ(rates.r_radps, 0.0);
  EXPECT_EQ(rates.steering_rad, 0.0);
  EXPECT_EQ(rates.u_mps, state_rates(*some_model().plant(), state, force, 0.0).u_mps);
}

TEST(Model, ListsTheParametersOfAMotion) {
  struct Takers {
    ParameterId id;
    bool steady_surge, steady_turn, straight;
  };
  const Takers all[] = {{ParameterId::kSurgeAlpha, true, false, true},
                        {ParameterId::kYawBeta, false, true, false},
                        {ParameterId::kWheelDeadZone, true, true, true},
                        {ParameterId::kMassNorm, false, false, true},
                        {ParameterId::kInertiaNorm, false, false, false},
                        {ParameterId::kSwayAlpha, false, false, false}};
  for (const Takers& expected : all) {
    SCOPED_TRACE(info(expected.id).name);
    EXPECT_EQ(takes(Motion::kSteadySurge, expected.id), expected.steady_surge);
    EXPECT_EQ(takes(Motion::kSteadyTurn, expected.id), expected.steady_turn);
    EXPECT_EQ(takes(Motion::kStraight, expected.id), expected.straight);
    EXPECT_TRUE(takes(Motion::kPlanar, expected.id));
  }
}

TEST(Model, HasThePapersLargestWheelForce) {
  // 37/0.0768 = 481.77 N                                                            [paper (66)]
  EXPECT_NEAR(max_wheel_force_n(37.0, 0.0768), 481.77, 0.005);
}

TEST(ModelFile, AnIntervalThatDoesNotExistIsNullOrLeftOut) {
  Model model = some_model();
  model.record.reports[0].parameters[0].profile95 = Interval{1.2, 1.4};
  const std::string text = model_text(model);
  const std::string key = "\"profile95\": ";
  const std::size_t begin = text.find(key) + key.size();
  ASSERT_NE(text.find(key), std::string::npos);
  const std::string with_null =
      text.substr(0, begin) + "null" + text.substr(text.find(']', begin) + 1);
  EXPECT_EQ(reread(text)->record.reports[0].parameters[0].profile95->hi, 1.4);
  ASSERT_TRUE(reread(with_null)) << to_text(reread(with_null).error());
  EXPECT_FALSE(reread(with_null)->record.reports[0].parameters[0].profile95);
}

TEST(ModelFile, IsReadBackBeforeItReplacesTheOldOne) {
  Model model = some_model();
  const ScratchFile file("model.json", model_text(model));
  ASSERT_TRUE(write_model(model, file.path()));
  model[ParameterId::kSurgeAlpha].value = 1e12;  // invalid: beyond the allowed range of a model
  const auto refused = write_model(model, file.path());
  ASSERT_FALSE(refused);
  EXPECT_EQ(exit_code(refused.error()), 3);
  EXPECT_TRUE(read_model(file.path())) << "the old file is still there";
}

}  // namespace
}  // namespace awmr::testing::model_file_test
