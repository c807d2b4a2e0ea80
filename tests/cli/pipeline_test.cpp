/// Full pipeline from the paper's tables to every output file, run through the program.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program.h"

namespace awmr::testing::pipeline_test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// One run of the whole pipeline with a short search for gains, shared by the tests below. If
/// AWMR_PAPER_RUN is set, it names the folder of the results, which examples.py then uses.
class Pipeline : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    temporary_ = new TemporaryDirectory;
    const char* kept = std::getenv("AWMR_PAPER_RUN");
    folder_ = kept != nullptr ? kept : temporary_->path() / "out";
    std::filesystem::remove_all(folder_);
    result_ = awmr("run '" + copied_project().string() + "' --json -o '" + folder_.string() + "'");
  }
  static void TearDownTestSuite() { delete temporary_; }
  /// The paper's project in a copy of its folders, so that its relative paths are the same.
  static std::filesystem::path copied_project() {
    const std::filesystem::path source = AWMR_SOURCE_DIR;
    for (const char* folder : {"configs", "datasets"}) {
      const std::filesystem::path copy = temporary_->path() / folder;
      std::filesystem::create_directory(copy);
      std::filesystem::copy(source / folder / "paper", copy / "paper",
                            std::filesystem::copy_options::recursive);
    }
    const std::filesystem::path project = temporary_->path() / "configs/paper/project.json";
    Json document = Json::parse(read_all(project));
    document["tune"] = "tune.json";
    write_all(project, document.dump());
    write_all(project.parent_path() / "tune.json",
              R"({"global_evaluations": 80, "local_evaluations": 30, "draws": 4,
                  "judged_draws": 40})");
    return project;
  }
  static Json json(const std::string& name) { return Json::parse(read_all(folder_ / name)); }
  static bool has_finding(const std::string& file, int line, const std::string& code) {
    const Json model = json("model.json");
    for (const Json& f : model.at("findings")) {
      if (f.at("file").get<std::string>().find(file) != std::string::npos && f.at("line") == line &&
          f.at("code") == code) {
        return true;
      }
    }
    return false;
  }
  static inline TemporaryDirectory* temporary_ = nullptr;
  static inline std::filesystem::path folder_;
  static inline ProcessResult result_;
};

TEST_F(Pipeline, EndsWellAndLeavesEveryFile) {
  ASSERT_EQ(result_.exit_code, 0) << result_.err;
  for (const char* name :
       {"model.json", "gains.json", "validation.json", "awmr_params.h", "comparison.csv",
        "comparison.json", "report.html", "firmware/src/awmr.cpp", "firmware/library.properties"}) {
    EXPECT_GT(read_all(folder_ / name).size(), 100u) << name;
  }
}

TEST_F(Pipeline, PrintsEveryStepAsJsonUnderTheNameOfItsFile) {
  const Json run = Json::parse(result_.out);
  EXPECT_EQ(run.at("command"), "run");
  for (const std::string step : {"model", "gains", "validation", "comparison"}) {
    EXPECT_EQ(run.at("result").at(step), json(step + ".json")) << step;
  }
  EXPECT_GT(run.at("written").size(), 7U);
}

TEST_F(Pipeline, NamesItsInputsRelativeToTheProjectAndItsOwnFilesByTheirNames) {
  const auto names = [](const std::string& file) {
    const Json document = json(file);
    std::vector<std::string> found;
    for (const Json& input : document.at("inputs")) found.push_back(input.at("name"));
    return found;
  };
  EXPECT_THAT(names("model.json"),
              ::testing::IsSupersetOf({"vehicle.json", "../../datasets/paper/surge.csv"}));
  EXPECT_EQ(names("gains.json").front(), "model.json");
  EXPECT_THAT(names("comparison.json"), ::testing::Contains("scenarios/c3_heading_steps.json"));
}

TEST_F(Pipeline, ReproducesTheReferenceFitsOfTables2And3) {
  // Values recomputed from the paper's printed tables; the tolerance is half a unit of the last
  // printed digit.
  const Json model = json("model.json");
  EXPECT_NEAR(model["/surge/alpha/value"_json_pointer].get<double>(), 1.3157, 5e-5);
  EXPECT_NEAR(model["/surge/beta/value"_json_pointer].get<double>(), 0.8841, 5e-5);
  EXPECT_NEAR(model["/yaw/alpha/value"_json_pointer].get<double>(), 0.3028, 5e-5);
  EXPECT_NEAR(model["/yaw/beta/value"_json_pointer].get<double>(), 0.8250, 5e-5);
}

TEST_F(Pipeline, FindsThePapersOwnInconsistenciesByFileAndLine) {
  const std::string surge = read_all(std::string(AWMR_SOURCE_DIR) + "/datasets/paper/surge.csv");
  const std::string turning =
      read_all(std::string(AWMR_SOURCE_DIR) + "/datasets/paper/turning.csv");
  const auto line_of = [](const std::string& text, const std::string& start) {
    const std::size_t at = text.find("\n" + start);
    EXPECT_NE(at, std::string::npos) << start;
    return 2 +
           static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
  };
  EXPECT_TRUE(has_finding("surge.csv", line_of(surge, "1.4,"), "speed-mismatch"));
  EXPECT_TRUE(has_finding("turning.csv", line_of(turning, "5,"), "yaw-rate-mismatch"));
  EXPECT_TRUE(has_finding("turning.csv", line_of(turning, "25,"), "steering-stop"));
}

TEST_F(Pipeline, TunedGainsBeatThePapersInEveryModeUnderTheConstraint) {
  const Json gains = json("gains.json");
  const double t1 = gains["/time_constants/T1_s"_json_pointer];
  const double t2 = gains["/time_constants/T2_s"_json_pointer];
  EXPECT_LT(t2, t1);
  for (const Json& constraint : gains.at("constraints")) EXPECT_GE(constraint.at("margin"), 0.0);
}

/// Two runs with the same inputs and a short search for gains write identical files.
TEST_F(Pipeline, GivesTheSameBytesAgain) {
  const TemporaryDirectory one, two;
  write_all(one.path() / "tune.json",
            R"({"global_evaluations": 10, "local_evaluations": 5, "draws": 1, "judged_draws": 2,
          "mode": "combined", "scenarios": ["turn.json"]})");
  Json project =
      Json::parse(read_all(std::string(AWMR_SOURCE_DIR) + "/configs/paper/project.json"));
  const auto below_configs = [](Json& path) {
    path = std::string(AWMR_SOURCE_DIR) + "/configs/paper/" + path.get<std::string>();
  };
  below_configs(project["vehicle"]);
  for (Json& trial : project["trials"]) below_configs(trial);
  Json turn =
      Json::parse(read_all(AWMR_SOURCE_DIR "/configs/paper/scenarios/c3_heading_steps.json"));
  turn["duration_s"] = 6;
  write_all(one.path() / "turn.json", turn.dump());
  project["compare"]["scenarios"] = {(one.path() / "turn.json").string()};
  project["tune"] = (one.path() / "tune.json").string();
  write_all(one.path() / "project.json", project.dump());
  for (const TemporaryDirectory* folder : {&one, &two}) {
    const ProcessResult run = awmr("run " + (one.path() / "project.json").string() + " -o " +
                                   (folder->path() / "out").string());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  for (const char* name : {"model.json", "gains.json", "awmr_params.h", "comparison.csv"}) {
    EXPECT_EQ(read_all(one.path() / "out" / name), read_all(two.path() / "out" / name)) << name;
  }
}

/// Returns the columns of forces, steering, speed and yaw rate of a synthetic log.
std::string log_without_positions(const std::string& path) {
  std::istringstream lines(read_all(path));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    std::vector<std::string> cell;
    for (std::string one; std::getline(cells, one, ',');) cell.push_back(one);
    for (const std::size_t i : {0, 1, 2, 3, 7}) text += cell.at(i) + ",";
    text += cell.at(8) + "\n";
  }
  return text;
}

/// No sensor measures the effect of the sway resistance. identify therefore reports it in a note as
/// not identifiable and assumes a value, with which tune continues.
TEST(RunOfALog, GoesOnWithAnAssumedSwayAsTuneDoes) {
  const std::string source = AWMR_SOURCE_DIR;
  const TemporaryDirectory directory;
  const std::filesystem::path& folder = directory.path();
  Json vehicle = Json::parse(read_all(source + "/configs/paper/vehicle.json"));
  vehicle.erase("sway_alpha");
  write_all(folder / "vehicle.json", vehicle.dump());
  write_all(folder / "log.csv", log_without_positions(source + "/datasets/synthetic/drive_2.csv"));
  write_all(folder / "tune.json",
            R"({"global_evaluations": 20, "local_evaluations": 10, "draws": 1, "judged_draws": 2,
          "mode": "combined"})");
  const Json project{{"schema", "awmr.project/1"},
                     {"vehicle", "vehicle.json"},
                     {"trials", {{"logs", {"log.csv"}}}},
                     {"identify", {{"family", {"power"}}}},
                     {"tune", "tune.json"},
                     {"compare",
                      {{"scenarios", {source + "/configs/paper/scenarios/c3_heading_steps.json"}},
                       {"samples", 4}}}};
  write_all(folder / "project.json", project.dump());
  const ProcessResult run =
      awmr("run " + (folder / "project.json").string() + " -o " + (folder / "out").string());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("not-identifiable"));
  for (const char* name : {"gains.json", "comparison.json", "report.html"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
  }
}

}  // namespace
}  // namespace awmr::testing::pipeline_test
