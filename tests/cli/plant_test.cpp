/// `--plant`: outputs and printed text name the plant used.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace awmr::testing::plant_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr const char* kC3 = "configs/paper/scenarios/c3_heading_steps.json";
constexpr const char* kUsualTyres =
    "four-wheel, friction 0.8, cornering stiffness 10 per rad, rest speed 0.1 m/s";

class PlantOption : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    static const TemporaryDirectory kept;
    model_ = (kept.path() / "model.json").string();
    gains_ = (kept.path() / "gains.json").string();
    write_all(gains_, R"({"heading": {"lambda": 3, "mu": 50, "epsilon": 12},
                          "speed": {"mu": 5, "epsilon": 1.2}})");
    const ProcessResult identified = awmr(
        "identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
        "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
        model_);
    ASSERT_EQ(identified.exit_code, 0) << identified.err;
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  static std::string with(const std::string& command, const std::string& words) {
    return fmt::format("{} --model {} --gains {} {}", command, model_, gains_, words);
  }
  /// Writes the scenario C3 with one key set to `value` and returns the path.
  std::string changed_c3(const std::string& key, const Json& value) const {
    Json scenario = Json::parse(read_all(std::string(AWMR_SOURCE_DIR) + "/" + kC3));
    scenario["name"] = "changed";
    scenario[key] = value;
    write_all(path("changed.json"), scenario.dump());
    return path("changed.json");
  }

  TemporaryDirectory directory_;
  inline static std::string model_, gains_;
};

/// Simulates two runs on tyres, one steered and one differential, fits the tyres to them, and uses
/// the fitted tyres.
TEST_F(PlantOption, TyresOfValidateAreThoseOfTheRuns) {
  Json scenario = Json::parse(read_all(std::string(AWMR_SOURCE_DIR) + "/" + kC3));
  scenario["duration_s"] = 32;
  scenario["guidance"]["steps"] = Json::array();
  for (int i = 0; i < 8; ++i) {
    scenario["guidance"]["steps"].push_back(
        {{"t_s", 4.0 * i}, {"psi_deg", i % 2 == 0 ? 25 + i : -20}});
  }
  scenario["tyres"] = {{"friction", 0.6}, {"cornering_stiffness_per_rad", 7}};
  write_all(path("turns.json"), scenario.dump());
  std::string logs;
  for (const std::string mode : {"differential", "steering"}) {
    const std::string csv = path(mode + ".csv");
    ASSERT_EQ(awmr(with("simulate", fmt::format("--scenario {} --mode {} -o {}", path("turns.json"),
                                                mode, csv)))
                  .exit_code,
              0);
    logs += " --log " + csv;
  }
  const std::string columns =
      " --column heading_deg=psi_rad*57.29577951308232 --column speed_mps=u_mps --column "
      "sway_mps=v_mps "
      "--column yaw_rate_radps=r_radps --column "
      "steering_cmd_deg=steering_cmd_rad*57.29577951308232";
  const ProcessResult found = awmr(fmt::format("validate --model {}{}{} --tyres -o {}", model_,
                                               logs, columns, path("tyres.json")));
  ASSERT_THAT(found.exit_code, ::testing::AnyOf(0, 1)) << found.err;
  const Json tyres = Json::parse(read_all(path("tyres.json"))).at("tyres");
  EXPECT_NEAR(tyres.at("friction").get<double>(), 0.6, 0.01);
  EXPECT_NEAR(tyres.at("cornering_stiffness_per_rad").get<double>(), 7.0, 0.1);
  EXPECT_EQ(tyres.at("better"), "four-wheel");

  const ProcessResult run =
      awmr(with("simulate", fmt::format("--scenario {} --mode combined --plant four-wheel "
                                        "--tyres {} --json -o {}",
                                        kC3, path("tyres.json"), path("run.csv"))));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(Json::parse(run.out).at("result").at("plant").get<std::string>(),
              HasSubstr("friction 0.6"));
  const ProcessResult compared =
      awmr(with("compare", fmt::format("--scenario {} --tyres {} -o {}", kC3, path("tyres.json"),
                                       path("compared"))));
  ASSERT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_THAT(read_all(path("compared") + "/comparison.json"), HasSubstr("tyres-simulated"));
  // Refused because no run would use these tyres.
  for (const char* plant : {"", "--plant model "}) {
    EXPECT_EQ(awmr(with("simulate", fmt::format("--scenario {} --mode combined {}--tyres {} -o {}",
                                                kC3, plant, path("tyres.json"), path("none.csv"))))
                  .exit_code,
              2)
        << plant;
  }
  EXPECT_EQ(awmr(with("compare", fmt::format("--scenario {} --plant model --tyres {} -o {}", kC3,
                                             path("tyres.json"), path("none"))))
                .exit_code,
            2);
  EXPECT_EQ(
      awmr(fmt::format("validate --model {} --tyres -o {}", model_, path("none.json"))).exit_code,
      2);
}

TEST_F(PlantOption, OfSimulateIsNamedAndChangesTheRun) {
  const auto run = [&](const std::string& words) {
    return awmr(with("simulate", fmt::format("--scenario {} --mode combined {} -o {}", kC3, words,
                                             path("run.csv"))));
  };
  EXPECT_THAT(run("").out, Not(HasSubstr("plant:")));
  const std::string model = read_all(path("run.csv"));
  EXPECT_EQ(run("--plant model").exit_code, 0);
  EXPECT_EQ(read_all(path("run.csv")), model);
  EXPECT_THAT(run("--plant four-wheel").out, HasSubstr(std::string("plant: ") + kUsualTyres));
  EXPECT_THAT(read_all(path("run.csv")), HasSubstr("tyre_power_mps"));
  EXPECT_EQ(Json::parse(run("--plant four-wheel --json").out).at("result").at("plant"),
            kUsualTyres);
}

TEST_F(PlantOption, OfCompareIsNamedInItsFilesAndByMerge) {
  const auto compare = [&](const std::string& words, const std::string& scenarios) {
    return awmr(with("compare", fmt::format("{} --scenario {}", words, scenarios)));
  };
  const auto options = [&](const std::string& name) {
    return Json::parse(read_all(path(name + "/comparison.json"))).at("options");
  };
  const ProcessResult whole = compare("--plant four-wheel --samples 1 -o " + path("whole"), kC3);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr(std::string("plant: ") + kUsualTyres));
  EXPECT_EQ(options("whole").at("plant"), kUsualTyres);
  for (const char* part : {"1/2", "2/2"}) {
    const std::string to = path(std::string("part") + part[0]);
    EXPECT_EQ(compare(fmt::format("--plant four-wheel --samples 1 --shard {} -o {}", part, to), kC3)
                  .exit_code,
              0);
  }
  const ProcessResult merged =
      awmr(fmt::format("merge {} {} -o {}", path("part1"), path("part2"), path("merged")));
  EXPECT_THAT(merged.out, HasSubstr(std::string("plant: ") + kUsualTyres));
  EXPECT_EQ(read_all(path("merged/comparison.json")), read_all(path("whole/comparison.json")));
  // Different plants are listed by scenario; without tyres and without the option nothing is
  // printed.
  const std::string tyred = changed_c3("tyres", {{"friction", 0.3}});
  ASSERT_EQ(compare("-o " + path("both"), std::string(kC3) + " " + tyred).exit_code, 0);
  EXPECT_THAT(options("both").at("plant").get<std::string>(),
              HasSubstr("headings 30 then -30 deg: model; changed: four-wheel, friction 0.3"));
  ASSERT_EQ(compare("-o " + path("plain"), kC3).exit_code, 0);
  EXPECT_FALSE(options("plain").contains("plant"));
}

TEST_F(PlantOption, OfCompareIsBothByDefaultAlsoInParts) {
  const auto compared = [&](const std::string& name, const std::string& words) {
    EXPECT_EQ(awmr(with("compare",
                        fmt::format("{} --samples 1 --scenario {} -o {}", words, kC3, path(name))))
                  .exit_code,
              0);
    return path(name) + "/comparison.json";
  };
  const std::string whole = read_all(compared("whole", ""));
  EXPECT_EQ(read_all(compared("both", "--plant both")), whole);
  const auto kinds = [](const std::string& text) {
    std::vector<std::string> all;
    const Json document = Json::parse(text);
    for (const Json& change : document["scenarios"][0]["decision"]["changes"])
      all.push_back(change["kind"]);
    return all;
  };
  EXPECT_THAT(kinds(whole), ::testing::ElementsAre("weights", "plant", "gains", "gains"));
  EXPECT_THAT(kinds(read_all(compared("one", "--plant model"))), ::testing::ElementsAre("weights"));
  compared("part1", "--shard 1/2");
  compared("part2", "--shard 2/2");
  EXPECT_EQ(awmr(fmt::format("merge {} {} -o {}", path("part1"), path("part2"), path("merged")))
                .exit_code,
            0);
  EXPECT_EQ(read_all(path("merged/comparison.json")), whole);
}

TEST_F(PlantOption, RefusesWhatHasNoMeaningOnTyresByName) {
  const ProcessResult slippery =
      awmr(with("simulate",
                "--scenario configs/scenarios/slippery_patch.json --mode combined "
                "--plant four-wheel -o " +
                    path("run.csv")));
  EXPECT_EQ(slippery.exit_code, 2);
  EXPECT_THAT(slippery.err,
              HasSubstr("--plant four-wheel: scenario 'left wheels on a slippery patch', "
                        "/slippery: a patch limits"));
  const ProcessResult corner =
      awmr(with("compare", "--scenario configs/scenarios/worst_corner.json --plant four-wheel -o " +
                               path("comparison")));
  EXPECT_EQ(corner.exit_code, 2);
  EXPECT_THAT(corner.err, HasSubstr("/corner: yaw.alpha has no effect on tyres"));
  const ProcessResult break_even =
      awmr(with("compare", "--break-even --scenario " + changed_c3("tyres", Json::object()) +
                               " -o " + path("comparison")));
  EXPECT_EQ(break_even.exit_code, 2);
  EXPECT_THAT(break_even.err, HasSubstr("--break-even"));
  EXPECT_THAT(break_even.err, HasSubstr("[conflict]"));
}

}  // namespace
}  // namespace awmr::testing::plant_test
