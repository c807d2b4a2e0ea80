/// Tutorial of datasets/rover: all its commands run in order, and the results are correct.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "cli/program.h"

namespace awmr::testing::tutorial_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kSource = AWMR_SOURCE_DIR;

/// The commands in the ```sh blocks of a document, one per line.
std::vector<std::string> commands_in(const std::string& path) {
  std::istringstream document(read_all(path));
  std::vector<std::string> lines;
  bool inside = false;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("```")) {
      inside = line == "```sh";
    } else if (inside) {
      lines.push_back(line);
    }
  }
  return lines;
}

/// True values used by datasets/rover/generate.py.
const std::map<std::string, double> kTruth{{"/surge/alpha", 2.05}, {"/surge/beta", 0.80},
                                           {"/yaw/alpha", 0.042},  {"/yaw/beta", 0.90},
                                           {"/mass_norm", 0.7},    {"/inertia_norm", 0.00879667}};

/// Expects each true value within the model's 95 % interval. In a model from tables, I'z is m'
/// times the Iz/m of a uniform box, as in the simulated rover, and its interval follows from that
/// of m'.
void expect_true(const fs::path& model_file) {
  const json model = json::parse(read_all(model_file));
  for (const auto& [pointer, truth] : kTruth) {
    const json& estimate = model[json::json_pointer(pointer)];
    EXPECT_LE(estimate["ci95"][0].get<double>(), truth) << model_file << pointer;
    EXPECT_GE(estimate["ci95"][1].get<double>(), truth) << model_file << pointer;
  }
}

TEST(Tutorial, LeadsFromABlankVehicleToTheBoardAndToTheTruth) {
  const TemporaryDirectory directory;
  fs::create_directory_symlink(kSource + "/datasets", directory.path() / "datasets");
  const std::vector<std::string> lines = commands_in(kSource + "/datasets/rover/README.md");
  ASSERT_GE(lines.size(), 15u);
  for (const std::string& line : lines) {
    const bool ours = line.starts_with("awmr ");
    const ProcessResult result =
        run_process(ours ? AWMR_PROGRAM + line.substr(4) : line, directory.path());
    ASSERT_EQ(result.exit_code, 0) << line << "\n" << result.out << result.err;
  }
  expect_true(directory.path() / "out/model.json");
  const json sway = json::parse(read_all(directory.path() / "out/model.json"))["sway"]["alpha"];
  EXPECT_LE(sway["ci95"][0].get<double>(), 60.0) << "the value assumed for common tyres";
  EXPECT_GE(sway["ci95"][1].get<double>(), 60.0);
  expect_true(directory.path() / "driven.json");
}

TEST(Tutorial, CheckProposesTheMappingThatTheProjectHas) {
  const TemporaryDirectory directory;
  const fs::path rover = directory.path() / "rover";
  ASSERT_EQ(awmr("init " + rover.string()).exit_code, 0);
  for (const char* name : {"vehicle.json", "surge.csv", "turning.csv", "coastdown.csv"}) {
    fs::copy_file(kSource + "/datasets/rover/" + name, rover / name,
                  fs::copy_options::overwrite_existing);
  }
  for (const char* name : {"heading_steps.json", "square.json"}) {
    json scenario = json::parse(read_all(rover / "scenarios" / name));
    scenario["speed_mps"] = 1;
    write_all(rover / "scenarios" / name, scenario.dump());
  }
  const ProcessResult result = awmr("check " + rover.string());
  EXPECT_EQ(result.exit_code, 2);
  for (const char* proposed :
       {R"("columns": {"surge.csv": {"wheel_force": "pwm/255", "elapsed_s": "ms*0.001"}})",
        R"("columns": {"turning.csv": {"wheel_force": "pwm/255", "elapsed_s": "ms*0.001"}})",
        R"("columns": {"coastdown.csv": {"t_s": "t_ms*0.001", "speed_mps": "kmh*0.2777778"}})"}) {
    EXPECT_THAT(result.err, ::testing::HasSubstr(proposed));
  }
}

}  // namespace
}  // namespace awmr::testing::tutorial_test
