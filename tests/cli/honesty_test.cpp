/// Files that do not belong together or must not be overwritten: results of another model, files
/// that the user edited, a log that the model was fitted to. Findings on stderr are also in the
/// output file.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program.h"

namespace awmr::testing::honesty_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kTables =
    "--surge datasets/paper/surge.csv --coastdown datasets/paper/coastdown.csv --turning "
    "datasets/paper/turning.csv";
/// Trials without turns, of whose model `suggest` simulates fewer trials.
constexpr const char* kStraightTables =
    "--surge datasets/paper/surge.csv --coastdown datasets/paper/coastdown.csv";
constexpr const char* kScenario = "--scenario configs/paper/scenarios/c3_heading_steps.json";
constexpr const char* kForeignGains = "gains-of-another-model";

std::set<std::string> codes_in(const Json& findings) {
  std::set<std::string> codes;
  for (const Json& finding : findings) codes.insert(finding.at("code"));
  return codes;
}

class Honesty : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    kept_ = new TemporaryDirectory;
    Json vehicle = Json::parse(read_all(AWMR_SOURCE_DIR "/configs/paper/vehicle.json"));
    vehicle["name"] = "another";
    vehicle["mass_kg"] = 41.0;
    write_all(kept("other_vehicle.json"), vehicle.dump());
    Json turn =
        Json::parse(read_all(AWMR_SOURCE_DIR "/configs/paper/scenarios/c3_heading_steps.json"));
    turn["duration_s"] = 6;
    turn["guidance"]["steps"][1]["t_s"] = 3;
    write_all(kept("turn.json"), turn.dump());
    write_all(kept("short.json"), R"({"global_evaluations": 20, "local_evaluations": 10,
                                      "mode": "combined", "scenarios": ["turn.json"]})");
    const std::string lines[] = {
        fmt::format("identify --vehicle configs/paper/vehicle.json {} -o {}", kTables,
                    kept("model.json")),
        fmt::format("identify --vehicle {} {} -o {}", kept("other_vehicle.json"), kTables,
                    kept("other.json")),
        fmt::format("identify --vehicle configs/paper/vehicle.json {} -o {}", kStraightTables,
                    kept("straight.json")),
        fmt::format("tune --nominal --config {} --model {} -o {}", kept("short.json"),
                    kept("model.json"), kept("gains.json"))};
    for (const std::string& line : lines) EXPECT_EQ(awmr(line).exit_code, 0) << line;
  }
  static void TearDownTestSuite() { delete kept_; }
  static std::string kept(const std::string& name) { return (kept_->path() / name).string(); }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }

  /// Returns the object that `--json` prints; checks that the exit code is 0 or 1.
  static Json result_of(const std::string& line) {
    const ProcessResult run = awmr(line + " --json");
    EXPECT_LE(run.exit_code, 1) << line << run.err;
    return Json::parse(run.out);
  }
  std::string simulate_line(const std::string& model, const std::string& run) const {
    return fmt::format("simulate --model {} --gains {} {} --mode combined -o {}", kept(model),
                       kept("gains.json"), kScenario, path(run));
  }
  /// Data embedded in the report page.
  Json page() const {
    const std::string html = read_all(path("report.html"));
    const std::string begin = "id=\"data\">";
    const std::size_t start = html.find(begin) + begin.size();
    return Json::parse(html.substr(start, html.find("</script>", start) - start));
  }
  /// Copies the first 800 lines of a synthetic log and returns the path.
  std::string first_rows_of(const std::string& name) const {
    std::istringstream all(read_all(AWMR_SOURCE_DIR "/datasets/synthetic/" + name));
    std::string rows;
    std::string line;
    for (int i = 0; i < 800 && std::getline(all, line); ++i) rows += line + "\n";
    write_all(path(name), rows);
    return path(name);
  }
  TemporaryDirectory directory_;

 private:
  static inline TemporaryDirectory* kept_ = nullptr;
};

TEST_F(Honesty, GainsOfAnotherModelAreNamedByEveryCommandThatTakesThem) {
  const std::string both =
      fmt::format("--model {} --gains {}", kept("other.json"), kept("gains.json"));
  const std::string lines[] = {
      fmt::format("simulate {} {} --mode combined -o {}", both, kScenario, path("run.csv")),
      fmt::format("compare {} {} -o {}", both, kScenario, path("comparison")),
      fmt::format("validate {} -o {}", both, path("validation.json")),
      fmt::format("emit {} -o {}", both, path("firmware")),
      fmt::format("export {} --format csv -o {}", both, path("export.csv"))};
  for (const std::string& line : lines) {
    EXPECT_THAT(codes_in(result_of(line).at("findings")), Contains(kForeignGains)) << line;
    EXPECT_THAT(awmr(line).err, HasSubstr(kForeignGains)) << line;
  }
  for (const char* file : {"run.csv.json", "comparison/comparison.json", "validation.json",
                           "firmware/awmr_emit.json"}) {
    const Json document = Json::parse(read_all(path(file)));
    EXPECT_THAT(codes_in(document.at("findings")), Contains(kForeignGains)) << file;
  }
}

TEST_F(Honesty, TheHeaderHasNoCertificateOfGainsOfAnotherModel) {
  const auto header_of = [&](const char* model, const char* options) {
    const std::string folder = path(model) + options;
    EXPECT_EQ(awmr(fmt::format("emit --model {} --gains {} {} -o {}", kept(model),
                               kept("gains.json"), options, folder))
                  .exit_code,
              0);
    return read_all(folder + "/awmr_params.h");
  };
  constexpr const char* kUnchecked = "stability with this model was not checked";
  for (const char* options : {"", "--header-only"}) {
    const std::string own = header_of("model.json", options);
    EXPECT_THAT(own, HasSubstr("worst case over the model's parameters"));
    EXPECT_THAT(own, Not(HasSubstr(kUnchecked)));
    const std::string other = header_of("other.json", options);
    EXPECT_THAT(other, Not(HasSubstr("damping")));
    EXPECT_THAT(other, Not(HasSubstr("delay margin")));
    EXPECT_THAT(other, HasSubstr(kUnchecked));
  }
}

TEST_F(Honesty, TuneWarnsOfABaselineOfAnotherModel) {
  const auto tune = [&](const char* model) {
    return fmt::format("tune --nominal --config {} --model {} --baseline {} -o {}",
                       kept("short.json"), kept(model), kept("gains.json"), path("tuned.json"));
  };
  EXPECT_THAT(codes_in(result_of(tune("other.json")).at("findings")), Contains(kForeignGains));
  EXPECT_THAT(codes_in(Json::parse(read_all(path("tuned.json"))).at("findings")),
              Contains(kForeignGains));
  EXPECT_THAT(codes_in(result_of(tune("model.json")).at("findings")), Not(Contains(kForeignGains)));
}

TEST_F(Honesty, OwnGainsAndGainsWrittenByHandHaveNoFinding) {
  const Json own = result_of(simulate_line("model.json", "run.csv"));
  EXPECT_THAT(codes_in(own.at("findings")), Not(Contains(kForeignGains)));
  const Json tuned = Json::parse(read_all(kept("gains.json")));
  const Json by_hand = {{"heading", tuned.at("heading")}, {"speed", tuned.at("speed")}};
  write_all(path("gains.json"), by_hand.dump());
  const Json run =
      result_of(fmt::format("simulate --model {} --gains {} {} --mode combined -o {}",
                            kept("other.json"), path("gains.json"), kScenario, path("run.csv")));
  EXPECT_THAT(codes_in(run.at("findings")), Not(Contains(kForeignGains)));
}

TEST_F(Honesty, GainsThatWereChangedAfterTuningHaveNoCertificate) {
  Json gains = Json::parse(read_all(kept("gains.json")));
  gains["heading"]["mu"] = 0.9 * gains["heading"]["mu"].get<double>();
  write_all(path("gains.json"), gains.dump());
  const Json result =
      result_of(fmt::format("emit --model {} --gains {} --header-only -o {}", kept("model.json"),
                            path("gains.json"), path("changed")));
  EXPECT_THAT(codes_in(result.at("findings")), Contains("gains-changed"));
  const std::string header = read_all(path("changed") + "/awmr_params.h");
  EXPECT_THAT(header, Not(HasSubstr("damping")));
  EXPECT_THAT(header, HasSubstr("stability was not checked"));
  const Json own = result_of(fmt::format("emit --model {} --gains {} --header-only -o {}",
                                         kept("model.json"), kept("gains.json"), path("own")));
  EXPECT_THAT(codes_in(own.at("findings")), Not(Contains("gains-changed")));
}

TEST_F(Honesty, EmitWarnsOfGainsThatHoldTheHeadingWeakly) {
  const auto codes_of_slower = [&](double share) {
    const Json tuned = Json::parse(read_all(kept("gains.json")));
    Json gains = {{"heading", tuned.at("heading")}, {"speed", tuned.at("speed")}};
    Json& heading = gains["heading"];
    heading["lambda"] = share * heading["lambda"].get<double>();
    heading["mu"] = share * share * heading["mu"].get<double>();
    heading["epsilon"] = share * heading["epsilon"].get<double>();
    write_all(path("gains.json"), gains.dump());
    const Json result =
        result_of(fmt::format("emit --model {} --gains {} -o {}", kept("model.json"),
                              path("gains.json"), path(fmt::format("firmware_{}", share))));
    return codes_in(result.at("findings"));
  };
  EXPECT_THAT(codes_of_slower(0.05), Contains("weak-heading"));
  EXPECT_THAT(codes_of_slower(1.0), Not(Contains("weak-heading")));
}

/// Obstacle avoidance takes up to 7 ms on the chip, waypoints 2 ms: of two models, with samples of
/// 5 ms and 10 ms, only the first with avoidance is too fast.
TEST_F(Honesty, EmitWarnsOfSampleTimesShorterThanAStepWithItsParts) {
  Json gains = Json::parse(read_all(kept("gains.json")));
  write_all(path("gains.json"),
            Json{{"heading", gains.at("heading")}, {"speed", gains.at("speed")}}.dump());
  const auto codes_at = [&](double sample_time_s, const std::string& options) {
    Json model = Json::parse(read_all(kept("model.json")));
    model["vehicle"]["sample_time_s"] = sample_time_s;
    write_all(path("model.json"), model.dump());
    return codes_in(result_of(fmt::format("emit --model {} --gains {} -o {} {}", path("model.json"),
                                          path("gains.json"), path("firmware"), options))
                        .at("findings"));
  };
  EXPECT_THAT(codes_at(0.005, "--with avoidance"), Contains("sample-time-of-the-chip"));
  EXPECT_THAT(codes_at(0.010, "--with avoidance"), Not(Contains("sample-time-of-the-chip")));
  EXPECT_THAT(codes_at(0.005, ""), Not(Contains("sample-time-of-the-chip")));
}

TEST_F(Honesty, AReportLeavesOutWhatIsNotOfItsModel) {
  for (const char* name : {"model.json", "gains.json"}) fs::copy(kept(name), path(name));
  ASSERT_EQ(awmr(simulate_line("model.json", "run_own_combined_tuned.csv")).exit_code, 0);
  ASSERT_EQ(awmr(simulate_line("other.json", "run_foreign_combined_tuned.csv")).exit_code, 0);
  fs::copy(path("run_own_combined_tuned.csv"), path("run_bare_combined_tuned.csv"));
  ASSERT_EQ(
      awmr(fmt::format("validate --model {} -o {}", kept("other.json"), path("validation.json")))
          .exit_code,
      0);
  const ProcessResult report = awmr("report " + directory_.path().string());
  ASSERT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.err, HasSubstr("run_foreign_combined_tuned.csv"));
  EXPECT_THAT(report.err, HasSubstr("run_bare_combined_tuned.csv"));
  EXPECT_THAT(report.err, HasSubstr("validation.json"));
  const Json data = page();
  ASSERT_EQ(data.at("runs").size(), 1U);
  EXPECT_EQ(data.at("runs")[0].at("scenario"), "own");
  EXPECT_FALSE(data.contains("validation"));
  EXPECT_TRUE(data.contains("gains"));
  const std::set<std::string> codes = codes_in(data.at("findings"));
  EXPECT_THAT(codes, Contains("result-of-another-model"));
  EXPECT_THAT(codes, Contains("result-without-origin"));
  // Replaces the model in the directory. The report must then leave out all results of the first
  // model.
  fs::copy(kept("other.json"), path("model.json"), fs::copy_options::overwrite_existing);
  ASSERT_EQ(awmr("report " + directory_.path().string()).exit_code, 0);
  EXPECT_FALSE(page().contains("gains"));
}

TEST_F(Honesty, EmitRefusesToReplaceWhatItDidNotWrite) {
  const std::string line = fmt::format("emit --model {} --gains {} -o {}", kept("model.json"),
                                       kept("gains.json"), path("firmware"));
  fs::create_directory(path("firmware"));
  write_all(path("firmware/README.md"), "mine");
  write_all(path("firmware/LICENSE"), "mine, too");
  const ProcessResult refused = awmr(line);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("firmware/README.md"));
  EXPECT_THAT(refused.err, HasSubstr("firmware/LICENSE"));
  EXPECT_EQ(read_all(path("firmware/README.md")), "mine");
  EXPECT_FALSE(fs::exists(path("firmware/awmr_params.h")));
  fs::remove_all(path("firmware"));
  ASSERT_EQ(awmr(line).exit_code, 0);
  EXPECT_EQ(awmr(line).exit_code, 0) << "its own files are replaced";
  const std::string header = read_all(path("firmware/awmr_params.h"));
  write_all(path("firmware/awmr_params.h"), header + "/* tuned by hand */\n");
  const ProcessResult edited = awmr(line);
  EXPECT_EQ(edited.exit_code, 2);
  EXPECT_THAT(edited.err, HasSubstr("firmware/awmr_params.h"));
  EXPECT_EQ(read_all(path("firmware/awmr_params.h")), header + "/* tuned by hand */\n");
}

TEST_F(Honesty, ALogOfTheFitIsNoValidation) {
  const std::string log = first_rows_of("drive_1.csv");
  const ProcessResult fit =
      awmr(fmt::format("identify --vehicle configs/paper/vehicle.json {} --log {} -o {}", kTables,
                       log, path("model.json")));
  ASSERT_LE(fit.exit_code, 1) << fit.err;
  const auto validate = [&](const std::string& model) {
    return codes_in(result_of(fmt::format("validate --model {} --log {} -o {}", model, log,
                                          path("validation.json")))
                        .at("findings"));
  };
  EXPECT_THAT(validate(path("model.json")), Contains("log-of-the-fit"));
  EXPECT_THAT(validate(kept("model.json")), Not(Contains("log-of-the-fit")));
}

// Each command is listed with the file to which it writes its findings.
TEST_F(Honesty, FindingsOnStderrAreThoseOfTheFile) {
  const std::string model = kept("model.json");
  const std::string both = fmt::format("--model {} --gains {}", model, kept("gains.json"));
  const std::pair<std::string, std::string> lines[] = {
      {fmt::format("identify --vehicle configs/paper/vehicle.json {} -o {}", kTables,
                   path("m.json")),
       "m.json"},
      {fmt::format("tune --nominal --config {} --model {} -o {}", kept("short.json"), model,
                   path("g.json")),
       "g.json"},
      {fmt::format("validate {} -o {}", both, path("v.json")), "v.json"},
      {fmt::format("simulate {} {} --mode combined -o {}", both, kScenario, path("run.csv")),
       "run.csv.json"},
      {fmt::format("compare {} {} --samples 3 -o {}", both, kScenario, path("c")),
       "c/comparison.json"},
      {fmt::format("emit {} -o {}", both, path("e")), "e/awmr_emit.json"},
      {fmt::format("suggest --model {} -o {}", kept("straight.json"), path("s.json")), "s.json"},
      {fmt::format("recover --runs 2 --model {} -o {}", model, path("r.json")), "r.json"}};
  std::set<std::string> seen;
  for (const auto& [line, file] : lines) {
    const Json result = result_of(line);
    const std::set<std::string> shown = codes_in(result.at("findings"));
    seen.insert(shown.begin(), shown.end());
    EXPECT_EQ(codes_in(Json::parse(read_all(path(file))).at("findings")), shown) << line;
    EXPECT_EQ(codes_in(result.at("result").at("findings")), shown) << line;
    const ProcessResult words = awmr(line + " --verbose");
    for (const std::string& code : shown) {
      EXPECT_THAT(words.err, HasSubstr("[" + code + "]")) << line;
    }
  }
  EXPECT_THAT(seen, Not(IsEmpty()));
}

/// Returns the document without the parts that depend on the order of the files: the list of inputs
/// and the order of keys.
nlohmann::json without_inputs(const Json& document) {
  nlohmann::json unordered = nlohmann::json::parse(document.dump());
  unordered.erase("inputs");
  return unordered;
}

TEST_F(Honesty, NoNumberDependsOnTheOrderOfFiles) {
  const std::string first = first_rows_of("drive_1.csv");
  const std::string second = first_rows_of("drive_2.csv");
  const std::pair<std::string, std::string> orders[] = {{first, second}, {second, first}};
  std::vector<nlohmann::json> fits, checks, gains;
  for (const auto& [one, other] : orders) {
    const std::string logs = fmt::format("--log {} --log {}", one, other);
    fits.push_back(without_inputs(
        result_of(fmt::format("identify --vehicle configs/paper/vehicle.json {} --family power "
                              "--bootstrap 5 -o {}",
                              logs, path("m.json")))["result"]));
    Json validation = result_of(fmt::format("validate --model {} {} -o {}", kept("model.json"),
                                            logs, path("v.json")))["result"];
    std::map<std::string, Json> by_file;
    for (const Json& log : validation["logs"]) by_file[log["file"].get<std::string>()] = log;
    validation["logs"] = by_file;
    validation.erase("findings");
    checks.push_back(without_inputs(validation));
  }
  Json slower = Json::parse(read_all(kept("turn.json")));
  slower["name"] = "slower";
  slower["speed_mps"] = 0.5;
  write_all(path("slower.json"), slower.dump());
  const std::string steps[] = {kept("turn.json"), path("slower.json")};
  for (const auto& list : {Json{steps[0], steps[1]}, Json{steps[1], steps[0]}}) {
    write_all(path("tune.json"), Json{{"global_evaluations", 20},
                                      {"local_evaluations", 10},
                                      {"draws", 2},
                                      {"judged_draws", 2},
                                      {"mode", "combined"},
                                      {"scenarios", list}}
                                     .dump());
    gains.push_back(without_inputs(
        result_of(fmt::format("tune --model {} --config {} -o {}", kept("model.json"),
                              path("tune.json"), path("g.json")))["result"]));
  }
  EXPECT_EQ(fits[0], fits[1]);
  EXPECT_EQ(checks[0], checks[1]);
  EXPECT_EQ(gains[0], gains[1]);
}

}  // namespace
}  // namespace awmr::testing::honesty_test
