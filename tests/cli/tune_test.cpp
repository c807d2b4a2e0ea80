/// The baseline gains and the certificate in the output of tune.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program.h"

namespace awmr::testing::tune_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr const char* kC3 = "configs/paper/scenarios/c3_heading_steps.json";

class TunedGains : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    awmr(
        "identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
        "--coastdown "
        "datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
        path("model.json"));
    // A short search, on one short scenario.
    Json scenario = Json::parse(read_all(std::string(AWMR_SOURCE_DIR) + "/" + kC3));
    scenario["duration_s"] = 6;
    write_all(path("turn.json"), scenario.dump());
    write_all(path("tune.json"), R"({"global_evaluations": 20, "local_evaluations": 10, "draws": 2,
                                     "judged_draws": 4, "scenarios": ["turn.json"]})");
    write_all(path("own.json"), R"({"heading": {"lambda": 2, "mu": 30, "epsilon": 5},
                                   "speed": {"mu": 6, "epsilon": 1.5}})");
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string path(const std::string& name) { return (directory_->path() / name).string(); }
  static ProcessResult tune(const std::string& more) {
    return awmr("tune --model " + path("model.json") + " --config " + path("tune.json") + " -o " +
                path("gains.json") + " " + more);
  }
  static Json gains() { return Json::parse(read_all(path("gains.json"))); }

  static inline TemporaryDirectory* directory_ = nullptr;
};

TEST_F(TunedGains, AreComparedWithTheFileThatIsGivenAsBaseline) {
  const ProcessResult run = tune("--mode steering --baseline " + path("own.json"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = gains();
  const Json& baseline = json.at("baseline");
  EXPECT_EQ(baseline.at("source"), path("own.json"));
  EXPECT_EQ(baseline.at("heading"), Json::parse(read_all(path("own.json"))).at("heading"));
  EXPECT_EQ(baseline.at("objective"), 1.0);
  EXPECT_EQ(json.at("options").at("baseline"), path("own.json"));
  bool is_input = false;
  for (const Json& input : json.at("inputs")) {
    is_input = is_input || input.at("name") == "own.json";
  }
  EXPECT_TRUE(is_input) << json.at("inputs");
  // The baseline is another set of gains, so the paper's gains are evaluated in addition to it.
  EXPECT_TRUE(json.at("robust").at("quantiles").at("steering").contains("paper"));
}

TEST_F(TunedGains, TakeTheBaselinesThatTheProgramKnowsByName) {
  ASSERT_EQ(tune("--mode combined --baseline paper").exit_code, 0);
  EXPECT_EQ(gains().at("baseline").at("source"), "paper");
  EXPECT_EQ(gains().at("baseline").at("heading").at("mu"), 50.0);
  ASSERT_EQ(tune("--mode combined --baseline pole-placement").exit_code, 0);
  EXPECT_EQ(gains().at("baseline").at("source"), "pole-placement");
}

TEST_F(TunedGains, OptionsReplaceTheKeysOfTheConfigurationWithANote) {
  Json config = Json::parse(read_all(path("tune.json")));
  config["mode"] = "steering";
  write_all(path("steering.json"), config.dump());
  const std::string start = "tune --model " + path("model.json") + " --config ";
  const std::string end = " --mode combined -o " + path("gains.json");
  const ProcessResult run = awmr(start + path("steering.json") + end);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(gains().at("mode"), "combined");
  const Json note = gains().at("findings").front();
  EXPECT_EQ(note.at("code"), "option-overrides");
  EXPECT_EQ(note.at("severity"), "note");
  EXPECT_EQ(note.at("message"), "--mode combined replaces steering of this file");
}

TEST_F(TunedGains, NoteKeysThatAFlagReplaces) {
  Json config = Json::parse(read_all(path("tune.json")));
  config["one_set"] = false;
  config["nominal"] = false;
  config.erase("draws");
  config.erase("judged_draws");
  config["no_observer"] = false;
  write_all(path("flags.json"), config.dump());
  const ProcessResult run =
      awmr("tune --model " + path("model.json") + " --config " + path("flags.json") +
           " --one-set --nominal --no-observer -o " + path("gains.json"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::string replaced;
  const Json written = gains();
  for (const Json& finding : written.at("findings")) {
    if (finding.at("code") != "option-overrides") continue;
    replaced += finding.at("message").get<std::string>();
  }
  for (const char* option : {"--one-set", "--nominal", "--no-observer"}) {
    EXPECT_THAT(replaced, HasSubstr(option));
  }
}

TEST_F(TunedGains, NoteKeysAboutDrawsThatANominalSearchIgnores) {
  ASSERT_EQ(tune("--nominal --mode combined").exit_code, 0);
  const Json note = gains().at("findings").front();
  EXPECT_EQ(note.at("code"), "option-overrides");
  EXPECT_EQ(note.at("message"), "--nominal draws no vehicles, so draws of this file has no effect");
}

TEST_F(TunedGains, RefuseABaselineThatIsNoGainsFile) {
  const ProcessResult missing = tune("--baseline " + path("absent.json"));
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("absent.json"));
  write_all(path("bad.json"), R"({"heading": {"lambda": 2, "mu": -30, "epsilon": 5},
                                 "speed": {"mu": 6, "epsilon": 1.5}})");
  const ProcessResult bad = tune("--baseline " + path("bad.json"));
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.json:/heading/mu"));
}

TEST_F(TunedGains, RefuseAnObserverThatTheConfigurationForbids) {
  for (const auto& [key, option] :
       {std::pair("\"no_observer\": true", "--observer"), {"\"observer\": {}", "--no-observer"}}) {
    write_all(path("observer.json"), std::string("{") + key + "}");
    const ProcessResult run = awmr("tune --model " + path("model.json") + " --config " +
                                   path("observer.json") + " -o " + path("x.json") + " " + option);
    EXPECT_EQ(run.exit_code, 2) << option;
    EXPECT_THAT(run.err, HasSubstr(std::string("error: ") + option));
    EXPECT_THAT(run.err, HasSubstr("[conflict]"));
  }
}

TEST_F(TunedGains, ExplainEachActiveLimit) {
  const ProcessResult run = tune("--mode differential");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::size_t shown = 0;
  const Json written = gains();
  for (const Json& one : written.at("search").at("active")) {
    const double percent = 100.0 * one.at("wider_gains").get<double>();
    const std::string name = one.at("name");
    EXPECT_THAT(run.out, HasSubstr((percent < 0.1 ? "< 0.1 %  " : " %  ") + name + " ("))
        << run.out;
    ++shown;
  }
  EXPECT_EQ(run.out.find("active limits  none") != std::string::npos, shown == 0) << run.out;
  EXPECT_THAT(run.out, Not(HasSubstr("by 0.0 %")));
}

TEST_F(TunedGains, OfOneModeAreExaminedThereAndWarnElsewhere) {
  const ProcessResult run = tune("--mode differential");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = gains();
  EXPECT_EQ(json.at("mode"), "differential");
  EXPECT_EQ(json.at("metrics").size(), 1U);
  EXPECT_EQ(json.at("robust").at("quantiles").size(), 1U);
  EXPECT_EQ(json.at("certificate").at("modes").size(), 1U);
  for (const Json& constraint : json.at("constraints")) {
    EXPECT_NE(constraint.at("name"), "steering rate");
  }
  const auto simulate = [](const std::string& mode) {
    return awmr("simulate --model " + path("model.json") + " --gains " + path("gains.json") +
                " --scenario " + kC3 + " --mode " + mode + " -o " + path("run.csv"));
  };
  EXPECT_THAT(simulate("steering").err, HasSubstr("gains-of-another-mode"));
  EXPECT_THAT(simulate("differential").err, Not(HasSubstr("gains-of-another-mode")));
}

TEST_F(TunedGains, CarryTheirCertificateIntoTheHeader) {
  const ProcessResult run = tune("--one-set");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("worst case"));
  const Json certificate = gains().at("certificate");
  EXPECT_EQ(certificate.at("set"), "95 %");
  double damping = 1.0;
  for (const auto& [mode, worst] : certificate.at("modes").items()) {
    damping = std::min(damping, worst.at("damping").at("min").get<double>());
    EXPECT_GT(worst.at("delay_margin").at("min_s"), 0.0) << mode;
  }
  EXPECT_EQ(certificate.at("damping_min"), damping);
  ASSERT_EQ(awmr("emit --header-only --model " + path("model.json") + " --gains " +
                 path("gains.json") + " -o " + path("firmware"))
                .exit_code,
            0);
  EXPECT_THAT(read_all(path("firmware/awmr_params.h")), HasSubstr("delay margin"));
}

}  // namespace
}  // namespace awmr::testing::tune_test
