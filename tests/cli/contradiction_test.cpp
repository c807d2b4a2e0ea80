/// Contradictory files, and results that do not belong together, are refused.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "awmr/core/files/hash.h"
#include "cli/program.h"

namespace awmr::testing::contradiction_test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kTables =
    "--surge datasets/paper/surge.csv --coastdown datasets/paper/coastdown.csv --turning "
    "datasets/paper/turning.csv";
constexpr const char* kScenario = "--scenario configs/paper/scenarios/c3_heading_steps.json";

class Contradiction : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    kept_ = new TemporaryDirectory;
    const std::string model = kept("model.json");
    EXPECT_EQ(
        awmr(fmt::format("identify --vehicle configs/paper/vehicle.json {} -o {}", kTables, model))
            .exit_code,
        0);
    write_all(kept("gains.json"), R"({"heading": {"lambda": 3, "mu": 50, "epsilon": 12},
                                      "speed": {"mu": 5, "epsilon": 1.2}})");
  }
  static void TearDownTestSuite() { delete kept_; }
  static std::string kept(const std::string& name) { return (kept_->path() / name).string(); }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }

  /// The model with one value edited by hand.
  std::string edited(const char* pointer, const Json& value) const {
    Json model = Json::parse(read_all(kept("model.json")));
    model[Json::json_pointer(pointer)] = value;
    write_all(path("edited.json"), model.dump());
    return path("edited.json");
  }
  static void expect_refused(const ProcessResult& result, const std::string& words, int code = 2) {
    EXPECT_EQ(result.exit_code, code) << result.out;
    EXPECT_THAT(result.err, HasSubstr(words));
  }
  TemporaryDirectory directory_;

 private:
  static inline TemporaryDirectory* kept_ = nullptr;
};

TEST_F(Contradiction, SuggestRefusesAnExtremeModel) {
  Json model = Json::parse(read_all(kept("model.json")));
  model["covariance"]["matrix"][0][1] = model["covariance"]["matrix"][1][0] = 1.0;
  write_all(path("odd.json"), model.dump());
  expect_refused(awmr("suggest --model " + path("odd.json")), "correlations contradict each other");
  model = Json::parse(read_all(kept("model.json")));
  model["surge"]["beta"]["value"] = 1e-6;
  model["surge"]["beta"]["ci95"] = nullptr;
  write_all(path("odd.json"), model.dump());
  expect_refused(awmr("suggest --model " + path("odd.json")), "is not finite at this model");
  expect_refused(awmr("suggest --model " + edited("/steering/time_constant_s/value", 1e-6)),
                 "too fast to be followed");
}

TEST_F(Contradiction, RecoverReportsRunsWithoutAResult) {
  const std::string recover = "recover --runs 3 --model " + kept("model.json");
  expect_refused(awmr(recover + " --joint"), "--joint: needs");
  expect_refused(awmr(recover + " --fit steering.time_constant_s"),
                 "has estimated steering.time_constant_s", 1);
  const ProcessResult requested = awmr(recover + " --fit surge.alpha -o " + path("recover.json"));
  ASSERT_EQ(requested.exit_code, 0) << requested.err;
  EXPECT_EQ(Json::parse(read_all(path("recover.json")))["parameters"].size(), 1U);
}

TEST_F(Contradiction, MergeRefusesAPartWithEditedRows) {
  for (const char* part : {"1", "2"}) {
    ASSERT_EQ(awmr(fmt::format("compare --model {} --gains {} {} --samples 3 --shard {}/2 -o {}",
                               kept("model.json"), kept("gains.json"), kScenario, part, path(part)))
                  .exit_code,
              0);
  }
  const auto merge = [&] {
    return awmr(fmt::format("merge {} {} -o {}", path("1"), path("2"), path("merged")));
  };
  const std::string csv = read_all(path("1/comparison.csv"));
  const std::size_t row = csv.find('\n') + 1;
  const auto with = [&](const std::string& text) {
    Json shard = Json::parse(read_all(path("1/shard.json")));
    shard["csv_sha256"] = sha256_hex(text);
    write_all(path("1/shard.json"), shard.dump());
    write_all(path("1/comparison.csv"), text);
  };
  for (const char* number : {"nan", "inf", "1e308"}) {
    // Finds the fifth cell of the row, the settling time.
    std::size_t cell = row;
    for (int i = 0; i < 4; ++i) cell = csv.find(',', cell) + 1;
    with(csv.substr(0, cell) + number + csv.substr(csv.find(',', cell)));
    expect_refused(merge(), "comparison.csv:2:1: this line is not a row");
    EXPECT_FALSE(fs::exists(path("merged")));
  }
  std::string columns = csv;
  columns.replace(csv.find("overshoot_deg"), 13, "undershoot_de");
  with(columns);
  expect_refused(merge(), "comparison.csv:1:1: the file does not have the columns");
  with(csv);
  EXPECT_EQ(merge().exit_code, 0);
}

TEST_F(Contradiction, RefusesACompassWithImpossibleNumbers) {
  const auto circle = [&](double centre, double ahead, double left) {
    std::string text = "t_s,field_ahead,field_left,yaw_rate_radps\n";
    for (int i = 0; i < 800; ++i) {
      const double t = 0.02 * i;
      text += fmt::format("{},{},{},0.8\n", t, centre + ahead * std::cos(0.8 * t),
                          -left * std::sin(0.8 * t));
    }
    write_all(path("field.csv"), text);
    return awmr(fmt::format("compass {} -o {}", path("field.csv"), path("compass.h")));
  };
  EXPECT_EQ(circle(20.0, 30.0, 30.0).exit_code, 0);
  expect_refused(circle(123456789.0, 3.0, 3.0), "too large compared with the field", 1);
  expect_refused(circle(0.0, 1e4, 1.0), "times weaker along one axis", 1);
}

TEST_F(Contradiction, RefusesAScenarioThatBeginsBeforeTheLog) {
  expect_refused(
      awmr(fmt::format("validate --model {} --gains {} --log datasets/synthetic/drive_2.csv {} "
                       "--draws 39 --from -5 -o {}",
                       kept("model.json"), kept("gains.json"), kScenario, path("v.json"))),
      "the log begins at 0 s, but --from is -5 s");
  expect_refused(awmr(fmt::format("validate --model {} --log datasets/synthetic/drive_2.csv "
                                  "--horizon 0.01 -o {}",
                                  kept("model.json"), path("v.json"))),
                 "no channel has readings");
}

}  // namespace
}  // namespace awmr::testing::contradiction_test
