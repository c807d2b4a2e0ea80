/// `awmr check` reports missing and implausible values of a project before any fit.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace awmr::testing::check_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A project as written by `awmr init`, filled in for a rover of 2.1 kg.
class Check : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(awmr("init " + project()).exit_code, 0);
    nlohmann::ordered_json vehicle = read("vehicle.json");
    vehicle.merge_patch(
        {{"mass_kg", 2.1},
         {"length_m", 0.32},
         {"width_m", 0.22},
         {"front_axle_m", 0.1},
         {"half_track_m", 0.085},
         {"wheel_force", {{"min", -1}, {"max", 1}}},
         {"steering", {{"max_deg", 25}, {"max_rate_degps", 200}, {"time_constant_s", 0.05}}},
         {"sample_time_s", 0.02},
         {"sway_alpha", 90}});
    write("vehicle.json", vehicle);
    for (const char* scenario : {"scenarios/heading_steps.json", "scenarios/square.json"}) {
      nlohmann::ordered_json json = read(scenario);
      json["speed_mps"] = 0.8;
      write(scenario, json);
    }
    // Runs of a vehicle with a1 = 2.2, b1 = 0.7, a3 = 0.05, b3 = 0.8, m' = 0.9; times are rounded
    // to 0.01 s.
    write_all(path("surge.csv"),
              "wheel_force,distance_m,elapsed_s\n0.2,5,21.21\n0.3,5,11.89\n0.4,5,7.88\n"
              "0.5,5,5.73\n0.7,5,3.54\n0.9,5,2.47\n");
    write_all(path("turning.csv"),
              "steering_deg,wheel_force,turns,elapsed_s\n6,0.5,2,88.90\n10,0.5,2,47.13\n"
              "15,0.5,2,28.62\n20,0.5,2,20.20\n25,0.5,2,15.51\n");
    write_all(path("coastdown.csv"),
              "initial_speed_mps,stop_time_s\n0.8,1.28\n1.2,1.44\n1.6,1.57\n");
  }
  std::string project() const { return (directory_.path() / "rover").string(); }
  fs::path path(const std::string& name) const { return directory_.path() / "rover" / name; }
  nlohmann::ordered_json read(const std::string& name) const {
    return nlohmann::ordered_json::parse(read_all(path(name)));
  }
  void write(const std::string& name, const nlohmann::ordered_json& json) const {
    write_all(path(name), json.dump(2));
  }
  /// Runs check with one value of a file changed.
  ProcessResult check_with(const std::string& name, const std::string& pointer,
                           const nlohmann::ordered_json& value) const {
    nlohmann::ordered_json json = read(name);
    json[nlohmann::ordered_json::json_pointer(pointer)] = value;
    write(name, json);
    return awmr("check " + project());
  }
  /// Runs `awmr run` on the project with a short search for gains of one mode and few simulated
  /// runs.
  ProcessResult run() {
    write("tune.json", {{"global_evaluations", 20},
                        {"local_evaluations", 10},
                        {"draws", 1},
                        {"judged_draws", 4},
                        {"mode", "combined"}});
    nlohmann::ordered_json json = read("project.json");
    json["tune"] = "tune.json";
    json["compare"] = {{"scenarios", {"scenarios/heading_steps.json"}}, {"samples", 4}};
    write("project.json", json);
    return awmr("run " + path("project.json").string() + " -o " + path("out").string());
  }
  TemporaryDirectory directory_;
};

TEST_F(Check, AFilledProjectHasNoProblems) {
  const ProcessResult result = awmr("check " + project());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("no problems found; next: awmr run"));
  EXPECT_EQ(awmr("check " + path("project.json").string()).exit_code, 0);
}

TEST_F(Check, AProjectWithoutProblemsGivesGainsAndAHeader) {
  const ProcessResult result = run();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::ordered_json model = read("out/model.json");
  for (const auto& [pointer, truth] : {std::pair{"/surge/alpha", 2.2},
                                       {"/surge/beta", 0.7},
                                       {"/yaw/alpha", 0.05},
                                       {"/yaw/beta", 0.8},
                                       {"/mass_norm", 0.9}}) {
    const auto interval = model.at(nlohmann::ordered_json::json_pointer(pointer)).at("ci95");
    EXPECT_LE(interval[0], truth) << pointer;
    EXPECT_GE(interval[1], truth) << pointer;
  }
  EXPECT_GT(read("out/gains.json")["heading"]["lambda"], 0.0);
  EXPECT_THAT(read_all(path("out/awmr_params.h")), HasSubstr("#define AWMR_HEADING_LAMBDA"));
}

TEST_F(Check, TablesWithoutASwayResistanceGiveGainsAndAHeader) {
  const ProcessResult checked = check_with("vehicle.json", "/sway_alpha", nullptr);
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.err, HasSubstr("vehicle.json:/sway_alpha: "));
  const ProcessResult result = run();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("assumed-sway"));
  const nlohmann::ordered_json model = read("out/model.json");
  const auto& sway = model["sway"]["alpha"];
  // The assumed sway resistance is c g m'/u with c = sqrt(0.5 * 16), the fitted m', and u = half
  // the speed of the fastest surge run, 2.02 m/s.
  const double value =
      std::sqrt(8.0) * 9.80665 * model["mass_norm"]["value"].get<double>() / 1.0121;
  EXPECT_NEAR(sway["value"].get<double>(), value, 1e-3 * value);
  EXPECT_EQ(sway["source"], "derived");
  const double factor = sway["ci95"][1].get<double>() / sway["value"].get<double>();
  EXPECT_GT(factor, 5.6);
  EXPECT_LT(factor, 6.2);
  const auto& names = model["covariance"]["parameters"];
  EXPECT_THAT(names, ::testing::Contains("sway.alpha"))
      << "tune draws plants from the covariance, which must include the assumed value";
  EXPECT_THAT(read_all(path("out/awmr_params.h")), HasSubstr("#define AWMR_SWAY_ALPHA"));
}

TEST_F(Check, ThePapersProjectHasNoProblems) {
  const ProcessResult result = awmr("check configs/paper/project.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("speed-mismatch")) << "its contradictions are reported";
}

TEST_F(Check, ListsWhatIsMissingInOrder) {
  const std::string fresh = (directory_.path() / "fresh").string();
  ASSERT_EQ(awmr("init " + fresh).exit_code, 0);
  const ProcessResult result = awmr("check --quiet " + fresh);
  EXPECT_EQ(result.exit_code, 1);
  const std::size_t mass = result.err.find("vehicle.json:/mass_kg: to be filled in");
  const std::size_t surge = result.err.find("surge.csv: no runs yet: record a surge trial");
  const std::size_t speed = result.err.find("square.json:/speed_mps: to be filled in");
  EXPECT_LT(mass, surge) << result.err;
  EXPECT_LT(surge, speed);
  EXPECT_NE(speed, std::string::npos);
  EXPECT_THAT(result.err, Not(HasSubstr("yaw_inertia_kgm2"))) << "optional: the box is used";
}

TEST_F(Check, DescribesTheTrialsOfTheDriveBeforeTheVehicleIsFilledIn) {
  const std::string fresh = (directory_.path() / "fresh").string();
  ASSERT_EQ(awmr("init " + fresh + " --drive differential").exit_code, 0);
  const ProcessResult result = awmr("check --quiet " + fresh);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("vehicle.json:/mass_kg: to be filled in"));
  const std::size_t turning = result.err.find("turning.csv: ");
  ASSERT_NE(turning, std::string::npos) << result.err;
  const std::string message = result.err.substr(turning, result.err.find('\n', turning) - turning);
  EXPECT_THAT(message, AllOf(HasSubstr("force_left"), Not(HasSubstr("steering"))));
}

TEST_F(Check, NamesParametersWithoutATrial) {
  nlohmann::ordered_json json = read("project.json");
  json["trials"].erase("coastdown");
  write("project.json", json);
  const ProcessResult result = awmr("check " + project());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("no trial determines mass_norm"));
}

TEST_F(Check, WrongUnitsOfTheVehicleAreNamedWithTheConvertedValue) {
  const std::tuple<const char*, double, const char*> cases[] = {
      {"/mass_kg", 2100, "looks like g: 2.1"},
      {"/length_m", 320, "looks like mm: 0.32"},
      {"/width_m", 22, "looks like cm: 0.22"},
      {"/half_track_m", 85, "looks like mm: 0.085"},
      {"/half_track_m", 0.17, "looks like the whole track: 0.085"},
      {"/front_axle_m", 0.2, "looks like the wheelbase: 0.1"},
      {"/yaw_inertia_kgm2", 5.841, "omit the key to use the inertia of the box"},
      {"/yaw_inertia_kgm2", 264, "looks like kg cm^2: 0.0264"},
      {"/steering/max_deg", 0.436, "looks like radians: 24.98"},
      {"/steering/max_rate_degps", 3.49, "looks like rad/s: 200"},
      {"/steering/time_constant_s", 50, "looks like ms: 0.05"},
  };
  const nlohmann::ordered_json good = read("vehicle.json");
  for (const auto& [pointer, value, words] : cases) {
    const ProcessResult result = check_with("vehicle.json", pointer, value);
    EXPECT_EQ(result.exit_code, 1) << pointer;
    EXPECT_THAT(result.err,
                AllOf(HasSubstr(std::string("vehicle.json:") + pointer), HasSubstr(words)));
    EXPECT_THAT(result.out, HasSubstr("1 implausible")) << pointer << "\n" << result.err;
    write("vehicle.json", good);
  }
}

TEST_F(Check, NumbersBeyondEveryVehicleAreBadInputWithTheLikelyUnit) {
  const ProcessResult length = check_with("vehicle.json", "/length_m", 1320);
  EXPECT_EQ(length.exit_code, 2);
  EXPECT_THAT(length.err, HasSubstr("looks like mm: 1.32"));
  EXPECT_THAT(check_with("vehicle.json", "/sample_time_s", 20).err,
              HasSubstr("looks like ms: 0.02"));
}

TEST_F(Check, IdentifyRefusesImpossibleValuesUnlessAsIs) {
  nlohmann::ordered_json vehicle = read("vehicle.json");
  vehicle["half_track_m"] = 0.17;
  write("odd.json", vehicle);
  const std::string identify = "identify --vehicle " + path("odd.json").string() + " --surge " +
                               path("surge.csv").string() + " -o " + path("m.json").string();
  const ProcessResult refused = awmr(identify);
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("odd.json:/half_track_m"));
  EXPECT_FALSE(std::filesystem::exists(path("m.json")));
  const ProcessResult result = awmr(identify + " --as-is");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("warning: "), HasSubstr("[implausible-vehicle]")));
}

TEST_F(Check, EmitAndRunRefuseImpossibleValuesUnlessAsIs) {
  ASSERT_EQ(
      awmr("identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
           "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
           path("model.json").string())
          .exit_code,
      0);
  const nlohmann::ordered_json good = read("model.json");
  write("gains.json", {{"heading", {{"lambda", 3}, {"mu", 50}, {"epsilon", 12}}},
                       {"speed", {{"mu", 5}, {"epsilon", 1.2}}}});
  const std::string emit = "emit --header-only --model " + path("odd.json").string() + " --gains " +
                           path("gains.json").string() + " -o " + path("firmware").string();
  for (const auto& [key, value] :
       {std::pair("half_track_m", 0.5), std::pair("half_track_m", 0.05),
        std::pair("front_axle_m", 0.7), std::pair("length_m", 132.0),
        std::pair("yaw_inertia_kgm2", 584.1), std::pair("mass_kg", 37000.0)}) {
    nlohmann::ordered_json odd = good;
    odd["vehicle"][key] = value;
    write("odd.json", odd);
    const ProcessResult refused = awmr(emit);
    EXPECT_EQ(refused.exit_code, 2) << key;
    EXPECT_THAT(refused.err, HasSubstr(std::string("odd.json:/vehicle/") + key)) << key;
    EXPECT_FALSE(std::filesystem::exists(path("firmware"))) << key;
    EXPECT_EQ(awmr(emit + " --as-is").exit_code, 0) << key;
    std::filesystem::remove_all(path("firmware"));
  }
}

TEST_F(Check, ContradictionsOfTheTrialsNameTheUnitFix) {
  write_all(path("surge.csv"),
            "wheel_force,distance_m,elapsed_s\n51,5,12.5\n102,5,5.9\n153,5,3.8\n204,5,2.8\n");
  const ProcessResult result = awmr("check " + project());
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("surge.csv:2: tau_speed is"), HasSubstr("8-bit PWM counts"),
                    HasSubstr(R"(`"columns": {"wheel_force": ")"), HasSubstr("[contradiction]")));
  EXPECT_THAT(result.err, Not(HasSubstr("--column")));  // `check` has no option --column
}

TEST_F(Check, MillisecondsOfEveryTrialAreNamed) {
  write_all(path("surge.csv"), "wheel_force,distance_m,elapsed_s\n0.2,5,12500\n0.8,5,2800\n");
  write_all(path("turning.csv"),
            "steering_deg,wheel_force,turns,elapsed_s\n8,0.5,2,26000\n25,0.5,2,7400\n");
  write_all(path("coastdown.csv"), "initial_speed_mps,stop_time_s\n1.2,900\n0.8,700\n");
  const ProcessResult result = awmr("check " + project());
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 implausible"));
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("surge.csv:2:"), HasSubstr("turning.csv:2:"),
                    HasSubstr(R"(`"columns": {"stop_time_s": "\"stop_time_s\"*0.001"}`)")));
}

/// Trials without errors with g1 = 0.1 + 0.75 u and m' = 0.9: no power law describes the runs over
/// 10 m. A vehicle that starts at u0 comes to rest after (0.9/0.75) ln(1 + 7.5 u0).
TEST_F(Check, RunGivesTheFamilyAsTheJsonThatSelectsIt) {
  std::string surge = "wheel_force,distance_m,elapsed_s\n";
  for (int i = 1; i <= 12; ++i) {
    const double wheel_force = 0.075 * i;
    surge += fmt::format("{},10,{:.4f}\n", wheel_force, 7.5 / (4.0 * wheel_force - 0.1));
  }
  write_all(path("surge.csv"), surge);
  write_all(path("coastdown.csv"),
            "initial_speed_mps,stop_time_s\n0.8,2.335\n1.2,2.763\n1.6,3.078\n");
  const std::string literal = R"("identify": {"family": ["surge=coulomb-linear"]})";
  const ProcessResult first = run();
  EXPECT_LE(first.exit_code, 1) << first.err;
  EXPECT_THAT(first.err,
              AllOf(HasSubstr("power-law-inadequate"), HasSubstr("use `" + literal + "`")));
  nlohmann::ordered_json json = read("project.json");
  json.update(nlohmann::ordered_json::parse("{" + literal + "}"));
  write("project.json", json);
  const ProcessResult second = run();
  EXPECT_LE(second.exit_code, 1) << second.err;
  EXPECT_THAT(second.err, Not(HasSubstr("power-law-inadequate")));
}

TEST_F(Check, AnUnreadableFileIsBadInput) {
  write_all(path("surge.csv"), "wheel_force,distance_m,elapsed_s\n0.2,5,fast\n");
  EXPECT_EQ(awmr("check " + project()).exit_code, 2);
  fs::remove(path("surge.csv"));
  const ProcessResult result = awmr("check " + project());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("surge.csv"));
  EXPECT_EQ(check_with("vehicle.json", "/mas_kg", 2).exit_code, 2);
}

TEST_F(Check, AMistypedMappingIsNamedThoughATrialIsLackingAltogether) {
  nlohmann::ordered_json json = read("project.json");
  json["trials"].erase("coastdown");
  write("project.json", json);
  const ProcessResult result = check_with("project.json", "/columns", {{"elapsed_s", "elapsd_s"}});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("did you mean \"elapsed_s\"?"));
}

TEST_F(Check, AMappingForATrialThatIsStillEmptyIsNoError) {
  write_all(path("surge.csv"), "pwm,distance_m,elapsed_s\n");
  const ProcessResult result = check_with("project.json", "/columns", {{"wheel_force", "pwm/255"}});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no runs yet"));
}

}  // namespace
}  // namespace awmr::testing::check_test
