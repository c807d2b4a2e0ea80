/// `--json`: one object on stdout for every command; one on stderr on failure.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.h"

namespace awmr::testing::json_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

/// A model and nominal gains from the paper's tables, and command lines that use them.
class JsonOutput : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    identified_ = awmr(
        "identify --vehicle configs/paper/vehicle.json --surge datasets/paper/"
        "surge.csv --coastdown datasets/paper/coastdown.csv --turning "
        "datasets/paper/turning.csv --json -o " +
        path("model.json"));
    write_all(
        path("tune.json"),
        std::string(R"({"global_evaluations": 20, "local_evaluations": 10, "scenarios": [")") +
            AWMR_SOURCE_DIR + R"(/configs/paper/scenarios/c3_heading_steps.json"]})");
    tuned_ = awmr("tune --nominal --json --config " + path("tune.json") + " --model " +
                  path("model.json") + " -o " + path("gains.json"));
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string path(const std::string& name) { return (directory_->path() / name).string(); }
  static std::string loop() {
    return " --json --model " + path("model.json") + " --gains " + path("gains.json");
  }

  /// Stdout, which must be exactly one JSON object.
  static Json result_of(const ProcessResult& run, const std::string& command, int exit_code = 0) {
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_THAT(run.err, IsEmpty());
    const Json json = Json::parse(run.out);
    EXPECT_EQ(json.at("schema"), "awmr.result/1");
    EXPECT_EQ(json.at("command"), command);
    EXPECT_EQ(json.at("exit_code"), exit_code);
    for (const Json& file : json.at("written")) {
      EXPECT_TRUE(
          std::filesystem::exists(std::filesystem::path(AWMR_SOURCE_DIR) / file.get<std::string>()))
          << file;
    }
    return json;
  }

  static inline TemporaryDirectory* directory_ = nullptr;
  static inline ProcessResult identified_;
  static inline ProcessResult tuned_;
};

constexpr const char* kTurns = " --scenario configs/paper/scenarios/c3_heading_steps.json";

TEST_F(JsonOutput, HoldsTheDocumentThatIsInTheFile) {
  const Json identified = result_of(identified_, "identify");
  EXPECT_EQ(identified.at("result"), Json::parse(read_all(path("model.json"))));
  EXPECT_EQ(identified.at("findings"), identified.at("result").at("findings"));
  EXPECT_EQ(identified.at("written"), Json::array({path("model.json")}));
  const Json tuned = result_of(tuned_, "tune");
  EXPECT_EQ(tuned.at("result"), Json::parse(read_all(path("gains.json"))));
  const Json compared =
      result_of(awmr("compare" + loop() + kTurns + " -o " + path("compared")), "compare");
  EXPECT_EQ(compared.at("result"), Json::parse(read_all(path("compared/comparison.json"))));
  const Json validated =
      result_of(awmr("validate" + loop() + " -o " + path("validation.json")), "validate");
  EXPECT_EQ(validated.at("result"), Json::parse(read_all(path("validation.json"))));
  const std::string model = " --json --model " + path("model.json");
  const Json recovered =
      result_of(awmr("recover" + model + " --runs 5 -o " + path("recover.json")), "recover");
  EXPECT_EQ(recovered.at("result"), Json::parse(read_all(path("recover.json"))));
}

TEST_F(JsonOutput, HoldsWhatWouldBeInTheFileWhereNoneIsRequested) {
  const std::string model = " --json --model " + path("model.json");
  const Json suggested = result_of(awmr("suggest" + model), "suggest");
  EXPECT_EQ(suggested.at("result").at("schema"), "awmr.suggest/1");
  EXPECT_THAT(suggested.at("written"), IsEmpty());
  const Json mapped = result_of(awmr("map datasets/synthetic/drive_1.csv --json"), "map");
  EXPECT_EQ(mapped.at("result").at("schema"), "awmr.columns/1");
}

TEST_F(JsonOutput, NamesTheFiguresOfARunAsTheFilesDo) {
  const Json run = result_of(
      awmr("simulate" + loop() + kTurns + " --mode combined -o " + path("run.csv")), "simulate");
  const std::string csv = read_all(path("run.csv"));
  std::string header;
  for (const auto& [name, value] : run.at("result").at("last_row").items()) {
    EXPECT_THAT(csv.substr(0, csv.find('\n')), HasSubstr(name));
  }
  EXPECT_EQ(run.at("result").at("rows"), std::count(csv.begin(), csv.end(), '\n') - 1);
  awmr("compare" + loop() + kTurns + " -o " + path("compared"));
  const std::string table = read_all(path("compared/comparison.csv"));
  for (const auto& [name, value] : run.at("result").at("metrics").items()) {
    EXPECT_THAT(table.substr(0, table.find('\n')), HasSubstr(name));
  }
}

TEST_F(JsonOutput, OfOtherCommandsNamesTheFilesThatTheyWrote) {
  const Json emitted = result_of(awmr("emit" + loop() + " -o " + path("firmware")), "emit");
  EXPECT_GT(emitted.at("written").size(), 10U);
  EXPECT_GT(emitted.at("result").at("tables").at("surge").at("lines"), 1);
  result_of(awmr("export" + loop() + " --format csv -o " + path("all.csv")), "export");
  const Json begun = result_of(awmr("init --json " + path("rover")), "init");
  EXPECT_GE(begun.at("written").size(), 5U);
  const Json checked = result_of(awmr("check --json " + path("rover")), "check", 1);
  EXPECT_GT(checked.at("result").at("to_fill_in"), 0);
  EXPECT_GT(checked.at("findings").size(), 5U);
}

TEST_F(JsonOutput, OfAnErrorIsAnObjectOnStderr) {
  const std::vector<std::string> lines{
      "identify --json --vehicle nowhere.json -o " + path("x"),
      "identify --json --vehicle configs/paper/vehicle.json -o " + path("x"),
      "tune --jsn --json",
      "tune --quiet --json --model " + path("model.json") + " -o " + path("x"),
      "run --json",
      "simulate --json --mode none",
      "compare" + loop() + " --scenario nowhere.json -o " + path("x")};
  for (const std::string& line : lines) {
    const ProcessResult run = awmr(line);
    EXPECT_EQ(run.exit_code, 2) << line;
    EXPECT_THAT(run.out, IsEmpty()) << line;
    const Json json = Json::parse(run.err);
    EXPECT_EQ(json.at("schema"), "awmr.error/1");
    EXPECT_EQ(json.at("exit_code"), 2);
    EXPECT_FALSE(json.at("errors").at(0).at("message").get<std::string>().empty()) << line;
  }
}

TEST_F(JsonOutput, IsTheSameEveryTime) {
  const std::string line = "recover --runs 2 --json --model " + path("model.json");
  EXPECT_EQ(awmr(line).out, awmr(line).out);
}

}  // namespace
}  // namespace awmr::testing::json_test
