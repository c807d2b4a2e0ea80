/// The firmware on the emulated chip, run through the program: the paper's scenarios bit for bit,
/// budgets, injected faults, the serial protocol over a pseudo-terminal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/emit/emit.h"
#include "cli/program.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kC3 = "configs/paper/scenarios/c3_heading_steps.json";
constexpr const char* kC8 = "configs/paper/scenarios/c8_waypoints.json";
constexpr const char* kC13 = "configs/paper/scenarios/c13_heading_steps.json";

/// Writes the model of the paper's vehicle and its nominal gains into a folder.
void make_inputs(const std::filesystem::path& folder) {
  const std::string model = (folder / "model.json").string();
  const ProcessResult run = awmr(
      "identify --quiet --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
      "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
      model);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ProcessResult tuned =
      awmr("tune --nominal --quiet --model " + model + " -o " + (folder / "gains.json").string());
  ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
}

/// Makes the files of the suites below once for all their processes (a fixture of ctest).
TEST(PilInputs, AreMade) {
  const char* const folder = std::getenv("AWMR_PIL_INPUTS");
  if (folder == nullptr) GTEST_SKIP() << "AWMR_PIL_INPUTS is not set";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  make_inputs(folder);
}

class Pil : public ::testing::Test {
 protected:
  /// Takes the files from AWMR_PIL_INPUTS, where the test PilInputs wrote them, or makes them.
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    if (const char* const made = std::getenv("AWMR_PIL_INPUTS")) {
      for (const char* name : {"model.json", "gains.json"}) {
        std::filesystem::copy(std::filesystem::path(made) / name, path(name));
      }
    } else {
      make_inputs(directory_->path());
    }
    write_compile_once();
  }
  static void TearDownTestSuite() { delete directory_; }

  /// Writes a wrapper of avr-g++ for `pil_on`, which compiles firmware with the same sources and
  /// options only once.
  static void write_compile_once() {
    const std::string compiler = path("compile_once/avr-g++");
    std::filesystem::create_directory(path("compile_once"));
    write_all(compiler,
              "#!/bin/sh -e\n"
              "for output; do :; done\n"  // the last argument
              "key=$({ echo \"$*\"; find src pil awmr_params.h -type f | sort | xargs sha256sum; } "
              "| sha256sum)\n"
              "kept='" +
                  path("compile_once/") +
                  "'${key%% *}\n"
                  "[ -f \"$kept\" ] || { '" AWMR_TOOL_AVR_GXX
                  "' \"$@\"; cp \"$output\" \"$kept\"; }\n"
                  "cp \"$kept\" \"$output\"\n");
    std::filesystem::permissions(compiler, std::filesystem::perms::owner_all);
  }

  static std::string path(const std::string& name) { return (directory_->path() / name).string(); }
  /// Runs `awmr pil` on these files.
  static ProcessResult pil_on(const std::string& model, const std::string& gains,
                              const std::string& scenario, const std::string& mode,
                              const std::string& options, const std::string& output = "pil.json") {
    return run_process("PATH='" + path("compile_once") + "':$PATH " AWMR_PROGRAM " pil --model " +
                           path(model) + " --gains " + path(gains) + " --scenario " + scenario +
                           " --mode " + mode + " " + options + " -o " + path(output),
                       AWMR_SOURCE_DIR);
  }
  static ProcessResult pil(const std::string& scenario, const std::string& mode,
                           const std::string& options, const std::string& output = "pil.json") {
    return pil_on("model.json", "gains.json", scenario, mode, options, output);
  }
  /// pil.json of `scenario` in combined mode. Each combination of scenario and options is run only
  /// once.
  static const Json& result_of(const std::string& scenario,
                               const std::string& options = kWithoutSearch) {
    static std::map<std::string, Json> results;
    const auto [entry, is_new] = results.try_emplace(scenario + options);
    if (is_new) {
      const ProcessResult run = pil(scenario, "combined", options, "shared.json");
      EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
      entry->second = result("shared.json");
    }
    return entry->second;
  }
  /// A copy of a scenario with at most this duration.
  static std::string shortened(const std::string& scenario, double duration_s) {
    Json json = Json::parse(read_all(std::filesystem::path(AWMR_SOURCE_DIR) / scenario));
    json["duration_s"] = std::min(json["duration_s"].get<double>(), duration_s);
    const std::string copy = path(std::filesystem::path(scenario).filename().string());
    write_all(copy, json.dump());
    return copy;
  }
  /// A scenario of 1 s, for tests that are about folders, compilers and links.
  static std::string brief() { return shortened(kC13, 1.0); }
  /// Runs `awmr pil` in combined mode on brief() with the installed compiler, after the shell
  /// command `export BEFORE`, which sets variables or changes the directory.
  static ProcessResult pil_after(const std::string& before, const std::string& options,
                                 const std::string& output = "after.json") {
    return run_process("export " + before + " && " + std::string(AWMR_PROGRAM) + " pil --model " +
                           path("model.json") + " --gains " + path("gains.json") + " --scenario " +
                           brief() + " --mode combined " + options + " -o " + path(output),
                       AWMR_SOURCE_DIR);
  }
  /// Options for tests that are not about the longest step: a tenth of the default search, or none.
  static constexpr const char* kShortSearch = " --hostile-steps 600";
  static constexpr const char* kWithoutSearch = " --hostile-steps 0";
  static bool exists(const std::string& name) { return std::filesystem::exists(path(name)); }
  static std::size_t entries(const std::string& name) {
    const std::filesystem::directory_iterator first(path(name)), last;
    return static_cast<std::size_t>(std::distance(first, last));
  }
  static Json result(const std::string& name = "pil.json") {
    return Json::parse(read_all(path(name)));
  }
  static double largest(const Json& differences) {
    double value = 0.0;
    for (const auto& [name, difference] : differences.items()) {
      if (name != "heading_deg") value = std::max(value, difference.get<double>());
    }
    return value;
  }
  static inline TemporaryDirectory* directory_ = nullptr;
};

/// Makes the row of a run in the README's table of cycles from its pil.json.
std::string readme_line(const std::string& name, const Json& json) {
  char line[200];
  std::snprintf(line, sizeof line, "| %s | %d / %.0f / %d | %.1f %% | %d | %.3f deg |",
                name.c_str(), json["cycles"]["min"].get<int>(),
                json["cycles"]["mean"].get<double>(), json["cycles"]["max"].get<int>(),
                100.0 * json["period_share"].get<double>(), json["cycles_bound"].get<int>(),
                json["difference_double"]["heading_deg"].get<double>());
  return line;
}

class PilScenario : public Pil,
                    public ::testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(PilScenario, RunsBitForBitAsOnTheHostAndWithinItsBudgets) {
  const auto [scenario, mode] = GetParam();
  // Bounds are the largest measured value of the nine runs plus 1 %.
  const int cycles_max = 10473;
  const ProcessResult run = pil(scenario, mode, "--cycles-max " + std::to_string(cycles_max));
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const Json json = result();
  EXPECT_EQ(largest(json["difference"]), 0.0);
  EXPECT_LE(json["difference_double"]["heading_deg"].get<double>(), 0.0079);
  // Optional parts that are not compiled in must not cost flash or RAM.
  EXPECT_LE(json["flash_bytes"].get<int>(), 12050);
  EXPECT_LE(json["ram_bytes"].get<int>(), 416);
  EXPECT_GT(json["stack_bytes"].get<int>(), 50);
  EXPECT_LE(json["stack_bytes"].get<int>(), 193);
  EXPECT_LE(json["cycles"]["max"].get<int>(), cycles_max);
  EXPECT_LT(json["cycles"]["min"].get<int>(), json["cycles"]["max"].get<int>());
  EXPECT_EQ(json["verdict"], "passed");
  // Random and extreme inputs ("hostile" steps) give the host's bits too, within the sample time.
  EXPECT_EQ(json["hostile"]["differing"].get<int>(), 0);
  EXPECT_GE(json["hostile"]["steps"].get<int>(), 6000);
  EXPECT_GT(json["cycles_bound"].get<int>(), json["cycles"]["max"].get<int>());
  EXPECT_LE(json["cycles_bound"].get<int>(), std::string(scenario) == kC8 ? 31550 : 13366);
  const bool in_readme = std::string(scenario) != kC13;
  const std::string name = std::string(scenario) == kC3 ? "C3 " : "C8 ";
  if (in_readme) {
    EXPECT_THAT(read_all(std::string(AWMR_SOURCE_DIR) + "/apps/awmr-pil/README.md"),
                HasSubstr(readme_line(name + mode, json)));
  }
}

std::string name_of_run(const ::testing::TestParamInfo<std::pair<const char*, const char*>>& test) {
  const std::string file = test.param.first;
  const std::size_t slash = file.rfind('/') + 1;
  return file.substr(slash, file.find('_') - slash) + "_" + test.param.second;
}

INSTANTIATE_TEST_SUITE_P(, PilScenario,
                         ::testing::Values(std::pair{kC3, "differential"},
                                           std::pair{kC3, "steering"}, std::pair{kC3, "combined"},
                                           std::pair{kC8, "differential"},
                                           std::pair{kC8, "steering"}, std::pair{kC8, "combined"}),
                         name_of_run);
/// C13 has the same firmware as C3, with other headings.
INSTANTIATE_TEST_SUITE_P(Long, PilScenario,
                         ::testing::Values(std::pair{kC13, "differential"},
                                           std::pair{kC13, "steering"},
                                           std::pair{kC13, "combined"}),
                         name_of_run);

class PilGuidance : public Pil, public ::testing::WithParamInterface<const char*> {
 protected:
  static void expect_leads_by_itself(const std::string& scenario, const std::string& options);
};

/// Expects the host's bits, at most 16.1 KiB of flash and 512 bytes of RAM; with the position
/// estimate 20 KiB and 640 bytes.
void PilGuidance::expect_leads_by_itself(const std::string& scenario, const std::string& options) {
  const ProcessResult run = pil(scenario, "combined", options);
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const Json json = result();
  EXPECT_EQ(largest(json["difference"]), 0.0);
  EXPECT_EQ(json["hostile"]["differing"].get<int>(), 0);
  const Json given =
      Json::parse(read_all(std::string(AWMR_SOURCE_DIR "/configs/") + GetParam() + ".json"));
  const bool is_estimated = given.contains("sensors") && given["sensors"].contains("gps");
  EXPECT_LE(json["flash_bytes"].get<int>(), is_estimated ? 20480 : 16512);
  EXPECT_LE(json["ram_bytes"].get<int>(), is_estimated ? 640 : 512);
  std::set<FirmwarePart> parts;
  std::istringstream with(json["options"]["with"].get<std::string>());
  for (std::string part; std::getline(with, part, ',');) {
    parts.insert(value_in(kFirmwarePartNames, part).value());
  }
  EXPECT_LE(json["cycles_bound"].get<std::uint32_t>(),
            longest_step_cycles(parts, ResistanceForm::kTable));
  const bool heading = std::string(GetParam()).find("heading") != std::string::npos ||
                       std::string(GetParam()) == "scenarios/low_battery";
  EXPECT_EQ(json["guidance_on_chip"].get<bool>(), !heading);
}

/// Runs the first half minute of each scenario and a tenth of the hostile steps.
TEST_P(PilGuidance, GuidanceOnTheChipGivesTheBitsOfTheHost) {
  expect_leads_by_itself(shortened(std::string("configs/") + GetParam() + ".json", 30.0),
                         kShortSearch);
}

/// One scenario for each set of the firmware's parts and laws.
constexpr const char* kGuided[] = {"paper/scenarios/c9_line",
                                   "paper/scenarios/c10_obstacle_between_waypoints",
                                   "paper/scenarios/c10_obstacle_on_line",
                                   "paper/scenarios/c11_lissajous",
                                   "paper/scenarios/c11_lissajous_closed",
                                   "paper/scenarios/c12_waypoints_and_line",
                                   "baselines/double_lane_change_pure_pursuit",
                                   "baselines/side_slope_ilos",
                                   "baselines/side_slope_stanley",
                                   "scenarios/docking",
                                   "scenarios/heading_steps_fixed_half",
                                   "scenarios/heading_steps_observer",
                                   "scenarios/heading_steps_observer_winding_up",
                                   "scenarios/noisy_sensors",
                                   "scenarios/obstacle_course",
                                   "scenarios/side_slope_observer",
                                   "scenarios/slalom"};

/// Scenarios with the same firmware as one of kGuided, with other paths, surfaces or disturbances.
constexpr const char* kGuidedElsewhere[] = {"scenarios/double_lane_change",
                                            "scenarios/figure_of_eight",
                                            "scenarios/gps_dropout",
                                            "scenarios/low_battery",
                                            "scenarios/side_slope",
                                            "scenarios/slippery_patch",
                                            "scenarios/wheel_failure",
                                            "scenarios/worst_corner",
                                            "paper/scenarios/experiment_waypoints",
                                            "baselines/double_lane_change_ilos",
                                            "baselines/side_slope_pure_pursuit"};

std::string name_of_file(const ::testing::TestParamInfo<const char*>& test) {
  return std::filesystem::path(test.param).filename().string();
}

INSTANTIATE_TEST_SUITE_P(, PilGuidance, ::testing::ValuesIn(kGuided), name_of_file);

/// Tier `long`: each scenario of kGuided and kGuidedElsewhere to its end.
class PilWholeScenario : public PilGuidance {};

TEST_P(PilWholeScenario, GuidanceOnTheChipGivesTheBitsOfTheHost) {
  expect_leads_by_itself(std::string("configs/") + GetParam() + ".json", "");
}

std::vector<const char*> all_guided() {
  std::vector<const char*> all(std::begin(kGuided), std::end(kGuided));
  all.insert(all.end(), std::begin(kGuidedElsewhere), std::end(kGuidedElsewhere));
  return all;
}

INSTANTIATE_TEST_SUITE_P(, PilWholeScenario, ::testing::ValuesIn(all_guided()), name_of_file);

/// The chip has the paper's heading law; another is refused, not replaced.
TEST_F(Pil, RefusesTheLqiByName) {
  const ProcessResult run =
      pil("configs/baselines/heading_steps_lqi.json", "combined", "", "refused.json");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find(":/control/heading_law: "), std::string::npos) << run.err;
  EXPECT_FALSE(exists("refused.json"));
}

/// If the vehicle only holds a heading that it has reached, the commands decay to the smallest
/// floating-point numbers.
TEST_F(Pil, ADecayingHeadingGivesTheHostsBitsInEveryMode) {
  for (const char* mode : {"differential", "steering"}) {
    const ProcessResult run = pil("configs/scenarios/low_battery.json", mode, kWithoutSearch);
    ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
    EXPECT_EQ(largest(result()["difference"]), 0.0) << mode;
  }
}

TEST_F(Pil, CompensatesFrictionDeadZoneAndBackEmfAsTheSimulator) {
  const auto given = [](double value, const char* unit) {
    return Json{{"value", value}, {"std_error", nullptr}, {"ci95", nullptr},
                {"unit", unit},   {"source", "given"},    {"method", "by hand"}};
  };
  Json friction = Json::parse(read_all(path("model.json")));
  friction["surge"]["family"] = "coulomb-power";
  friction["surge"]["coulomb"] = given(0.2, "1");
  friction["yaw"]["family"] = "coulomb-power";
  friction["yaw"]["coulomb"] = given(0.02, "m");
  Json zone = Json::parse(read_all(path("model.json")));
  zone["surge"]["family"] = "dead-zone";
  zone["wheel"]["dead_zone"] = given(0.05, "1");
  Json geared = zone;
  geared["motor"]["back_emf_s_per_m"] = given(0.15, "s/m");
  for (const Json& model : {friction, zone, geared}) {
    write_all(path("rest.json"), model.dump());
    const ProcessResult run = pil_on("rest.json", "gains.json", kC3, "combined", kShortSearch);
    ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
    EXPECT_EQ(largest(result()["difference"]), 0.0);
    EXPECT_LE(result()["difference_double"]["heading_deg"].get<double>(), 0.05);
    EXPECT_EQ(result()["hostile"]["differing"].get<int>(), 0);
    EXPECT_LE(result()["flash_bytes"].get<int>(), 16384);
  }
}

/// Neither scenario defines an observer. In the first, the headings come from the host; in the
/// second, the chip computes the guidance.
TEST_F(Pil, AnObserverTunedWithTheGainsWorksOnTheChip) {
  Json gains = Json::parse(read_all(path("gains.json")));
  gains["observer"] = {{"bandwidth_radps", 2.0}, {"yaw_max_m", 0.04}, {"surge_max", 1.3}};
  write_all(path("observed.json"), gains.dump());
  for (const std::string& scenario :
       {std::string(kC3), shortened("configs/scenarios/side_slope.json", 20.0)}) {
    const ProcessResult run =
        pil_on("model.json", "observed.json", scenario, "combined", kShortSearch);
    ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
    EXPECT_EQ(largest(result()["difference"]), 0.0);
    EXPECT_LE(result()["difference_double"]["heading_deg"].get<double>(), 0.05);
    EXPECT_EQ(result()["hostile"]["differing"].get<int>(), 0);
  }
}

TEST_F(Pil, EachModeHasItsOwnGainsAndObserverOnTheChip) {
  Json gains = Json::parse(read_all(path("gains.json")));
  gains["modes"]["differential"] = {
      {"heading", {{"lambda", 1.5}, {"mu", 20}, {"epsilon", 8}}},
      {"speed", {{"mu", 2}, {"epsilon", 1}}},
      {"observer", {{"bandwidth_radps", 2.0}, {"yaw_max_m", 0.04}, {"surge_max", 1.3}}}};
  write_all(path("by_mode.json"), gains.dump());
  for (const char* key : {"heading", "speed", "observer"}) {
    gains[key] = gains["modes"]["differential"][key];
  }
  gains.erase("modes");
  write_all(path("slow.json"), gains.dump());
  const auto difference = [&](const std::string& file, const std::string& mode) {
    const ProcessResult run = pil_on("model.json", file, kC3, mode, kShortSearch);
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    EXPECT_EQ(largest(result()["difference"]), 0.0) << mode;
    EXPECT_LE(result()["difference_double"]["heading_deg"].get<double>(), 0.05) << mode;
    return result()["difference_double"];
  };
  EXPECT_EQ(difference("by_mode.json", "combined"), difference("gains.json", "combined"));
  EXPECT_EQ(difference("by_mode.json", "differential"), difference("slow.json", "differential"));
}

TEST_F(Pil, ALineOverTheUartIsTheSameRun) {
  const std::string line = shortened("configs/paper/scenarios/c9_line.json", 8.0);
  // The serial line takes 1.5 kB more than the memory link, which stays within 16 KiB.
  ASSERT_EQ(pil(line, "combined", "--link uart --flash-max 16800 --hostile-steps 0", "uart.json")
                .exit_code,
            0);
  EXPECT_EQ(result("uart.json")["difference_double"], result_of(line)["difference_double"]);
  EXPECT_EQ(largest(result("uart.json")["difference"]), 0.0);
  EXPECT_EQ(result("uart.json")["options"]["with"], "line");
}

TEST_F(Pil, APartThatIsNotInUseChangesNoBit) {
  const std::string c8 = shortened(kC8, 40.0);
  const ProcessResult run =
      pil(c8, "combined", "--with line,observer,slow_down --hostile-steps 600", "with.json");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const Json with = result("with.json");
  EXPECT_EQ(result_of(c8)["difference_double"], with["difference_double"]);
  EXPECT_EQ(largest(with["difference"]), 0.0);
  EXPECT_GT(with["flash_bytes"].get<int>(), result_of(c8)["flash_bytes"].get<int>());
  EXPECT_EQ(with["options"]["optimize"], "size");
  EXPECT_EQ(pil(kC8, "combined", "--with lines", "none.json").exit_code, 2);
  EXPECT_EQ(pil(kC8, "combined", "--split half", "none.json").exit_code, 2);
}

TEST_F(Pil, CompiledForSizeItTakesLessFlashAndGivesTheSameBits) {
  const std::string c8 = shortened(kC8, 40.0);
  const ProcessResult run =
      pil(c8, "combined", "--optimize size --hostile-steps 600", "small.json");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const Json fast = result_of(c8), small = result("small.json");
  EXPECT_LT(small["flash_bytes"].get<int>(), fast["flash_bytes"].get<int>());
  EXPECT_GT(small["cycles"]["max"].get<int>(), fast["cycles"]["max"].get<int>());
  EXPECT_EQ(small["difference"], fast["difference"]);
  EXPECT_EQ(small["difference_double"], fast["difference_double"]);
  EXPECT_EQ(small["options"]["optimize"], "size");
  EXPECT_EQ(pil(kC8, "combined", "--optimize fast", "none.json").exit_code, 2);
}

TEST_F(Pil, RefusesOutputEqualToInput) {
  const std::string model = read_all(path("model.json"));
  const ProcessResult run = pil(kC13, "combined", "", "model.json");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("it is the input"));
  EXPECT_EQ(read_all(path("model.json")), model);
}

TEST_F(Pil, ByPowfItIsWithinTwoMillionths) {
  // The powf functions of chip and host differ by up to 2.4e-7. The steering's division by
  // tau_speed amplifies this: 1.3e-6 measured with these gains, at most 9e-7 with the
  // full-precision gains of awmr tune.
  const ProcessResult run =
      pil(kC3, "combined", "--resistance powf --difference-max 2e-6 --hostile-steps 0");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_LE(largest(result()["difference"]), 2e-6);
  EXPECT_LE(result()["cycles"]["max"].get<int>(), 19998);
}

constexpr const char* kFaults[] = {"nan",
                                   "infinite",
                                   "range",
                                   "mode",
                                   "heading-stale",
                                   "speed-stale",
                                   "command-timeout",
                                   "step-late",
                                   "parameters",
                                   "compass-silent",
                                   "compass-frozen",
                                   "compass-jump",
                                   "compass-stuck",
                                   "gyro-silent",
                                   "gyro-frozen",
                                   "gyro-range",
                                   "gyro-drift",
                                   "gps-silent",
                                   "gps-no-fix",
                                   "gps-empty",
                                   "gps-damaged",
                                   "gps-repeated",
                                   "gps-late",
                                   "gps-jump",
                                   "gps-speed-zero",
                                   "gps-position-frozen",
                                   "motors-reversed",
                                   "sides-swapped",
                                   "gyro-reversed",
                                   "steering-stuck",
                                   "servo-reversed",
                                   "compass-turning",
                                   "command-silence",
                                   "command-noise",
                                   "command-unknown",
                                   "command-repeated-frame",
                                   "stop",
                                   "stop-in-noise"};

/// Failures that are detected up to a minute after they begin, because only the motion shows them;
/// the others are detected within 6 s.
constexpr std::string_view kFoundInMotion[] = {
    "compass-stuck", "gps-speed-zero", "motors-reversed", "sides-swapped",
    "gyro-reversed", "steering-stuck", "servo-reversed",  "compass-turning"};

TEST(PilFaults, AreAllHazardsOfTheSafetyPage) {
  std::istringstream page(
      read_all(std::string(AWMR_SOURCE_DIR) + "/lib/awmr/emit/assets/SAFETY.md"));
  std::vector<std::string> hazards;
  for (std::string line; std::getline(page, line);) {
    // Skips lines that are not rows of the hazard table, which has five columns.
    if (std::count(line.begin(), line.end(), '|') != 6 || !line.ends_with("` |")) continue;
    const std::size_t name = line.rfind(" `") + 2;
    hazards.push_back(line.substr(name, line.size() - 3 - name));
  }
  EXPECT_EQ(hazards.size(), 29U);
  EXPECT_THAT(kFaults, ::testing::IsSupersetOf(hazards));
}

class PilFault : public Pil, public ::testing::WithParamInterface<const char*> {};

TEST_P(PilFault, GivesTheSafeCommandAndItsCode) {
  const std::string name = GetParam();
  // Failures that only the motion shows need a turn after the middle of the run. For a stuck servo
  // the turn is by 180 deg, because that failure is detected after metres at a wrong heading.
  const bool needs_motion = std::ranges::find(kFoundInMotion, name) != std::end(kFoundInMotion);
  Json scenario = Json::parse(read_all(std::filesystem::path(AWMR_SOURCE_DIR) / kC3));
  scenario["duration_s"] = needs_motion ? 90 : 30;
  scenario["guidance"]["steps"].push_back(
      {{"t_s", 60}, {"psi_deg", name == "steering-stuck" ? 150 : 30}});
  write_all(path("long.json"), scenario.dump());
  // In combined mode, wheel forces and steering compensate each other's failure.
  const bool is_of_servo = name == "steering-stuck" || name == "servo-reversed";
  const char* mode = name == "sides-swapped" ? "differential"
                     : is_of_servo           ? "steering"
                                             : "combined";
  const ProcessResult run = pil(path("long.json"), mode, "--inject " + name);
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const Json injected = result()["injected"];
  EXPECT_TRUE(injected["safe"].get<bool>());
  const int expected = injected["expected_fault"];
  const int fault = injected["fault"];
  EXPECT_NE(fault, 0);
  EXPECT_EQ(fault & ~expected, 0);
  EXPECT_TRUE(result()["cycles_bound"].is_null());
  EXPECT_EQ(injected["start_fault"].get<int>() != 0, GetParam() == std::string("parameters"));
}

INSTANTIATE_TEST_SUITE_P(, PilFault, ::testing::ValuesIn(kFaults), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_F(Pil, AChipResetDuringTheRunRestartsAsTheHostDoes) {
  const std::string line = shortened("configs/paper/scenarios/c9_line.json", 8.0);
  for (const auto& [scenario, link] : {std::pair{shortened(kC8, 40.0), "--link memory"},
                                       {line, "--link memory"},
                                       {line, "--link uart --line-noise 1e-4 --flash-max 16800"}}) {
    const ProcessResult run =
        pil(scenario, "combined", std::string("--inject reset ") + link, "reset.json");
    ASSERT_EQ(run.exit_code, 0) << scenario << link << run.out << run.err;
    const Json json = result("reset.json");
    EXPECT_EQ(json["restarts"].get<int>(), 1) << scenario << link;
    EXPECT_EQ(largest(json["difference"]), 0.0) << scenario << link;
    EXPECT_EQ(json["injected"]["fault"].get<int>(), 0) << scenario << link;
  }
  EXPECT_EQ(result_of(kC3)["restarts"].get<int>(), 0);
}

TEST_F(Pil, FailsOverABudgetAndNamesIt) {
  const ProcessResult run =
      pil(kC3, "steering", "--cycles-max 100 --ram-max 100 --flash-max 100 --hostile-steps 0");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("FAILED: cycles"));
  EXPECT_THAT(run.out, HasSubstr("FAILED: flash"));
  EXPECT_THAT(run.out, HasSubstr("FAILED: ram"));
  EXPECT_EQ(result()["verdict"], "failed");
}

TEST_F(Pil, BadInputExitsWith2) {
  const ProcessResult open =
      pil("configs/paper/scenarios/c1_full_thrust.json", "steering", "", "none.json");
  EXPECT_EQ(open.exit_code, 2);
  EXPECT_THAT(open.err, HasSubstr("/guidance"));
  EXPECT_EQ(pil(kC3, "sideways", "").exit_code, 2);
  EXPECT_EQ(pil(kC3, "steering", "--port /dev/null").exit_code, 2);
  EXPECT_EQ(pil(kC3, "steering", "--link uart --port /no/such/port").exit_code, 2);
}

TEST_F(Pil, OverTheUartItIsTheSameRun) {
  const Json uart = result_of(kC3, "--link uart --hostile-steps 0");
  EXPECT_EQ(uart["difference"], result_of(kC3)["difference"]);
  EXPECT_EQ(uart["difference_double"], result_of(kC3)["difference_double"]);
}

TEST_F(Pil, GivesTheSameRunOverALineThatFlipsBitsAndLosesBytes) {
  const ProcessResult run =
      pil(kC3, "combined", "--link uart --line-noise 1e-3 --hostile-steps 0", "noisy.json");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const Json quiet = result_of(kC3, "--link uart --hostile-steps 0"), noisy = result("noisy.json");
  EXPECT_EQ(quiet["repeats"].get<int>(), 0);
  EXPECT_GT(noisy["repeats"].get<int>(), 1000);
  for (const char* what : {"difference", "difference_double", "cycles", "samples", "checks"}) {
    EXPECT_EQ(quiet[what], noisy[what]) << what;
  }
}

TEST_F(Pil, ReportsALineThatFlipsAHundredthOfTheBits) {
  const ProcessResult run = pil(kC13, "combined", "--link uart --line-noise 1e-2", "none.json");
  EXPECT_EQ(run.exit_code, 1) << run.out;
  EXPECT_THAT(run.err, HasSubstr("the noise of the line"));
  EXPECT_FALSE(exists("none.json"));
  EXPECT_EQ(pil(kC13, "combined", "--line-noise 1e-3", "none.json").exit_code, 2);
  EXPECT_EQ(pil(kC13, "combined", "--link uart --line-noise nan", "none.json").exit_code, 2);
  EXPECT_EQ(pil(kC13, "combined", "--link uart --line-noise 0.6", "none.json").exit_code, 2);
}

TEST_F(Pil, OptionsAreNotUsedAfterTheyAreFreed) {
  // With these settings the C library overwrites freed memory at once. If CLI11 wrote to options
  // that are destroyed, the program would fail.
  const ProcessResult run = pil_after(
      "GLIBC_TUNABLES=glibc.malloc.tcache_count=0:glibc.malloc.perturb=165", kWithoutSearch);
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
}

TEST_F(Pil, NoShellReadsTheNameOfTheBuildDirectoryOrOfTmpdir) {
  std::filesystem::create_directory(path("x'; touch HACKED; echo '"));
  const ProcessResult kept =
      pil_after("A=b", "--build-dir \"" + path("k'; touch HACKED; echo '") + "\"" + kWithoutSearch);
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_TRUE(exists("k'; touch HACKED; echo '/pil_memory.elf"));
  const ProcessResult temporary =
      pil_after("TMPDIR=\"" + path("x'; touch HACKED; echo '") + "\"", kWithoutSearch);
  EXPECT_EQ(temporary.exit_code, 0) << temporary.err;
  for (const std::string& place : {path(""), path("x'"), std::string(AWMR_SOURCE_DIR)}) {
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(place) / "HACKED")) << place;
  }
}

TEST_F(Pil, TheCompilerDoesNotSeeTheUsersCompilerVariables) {
  const ProcessResult run =
      pil_after("CPATH=" + path("evil") + " GCC_EXEC_PREFIX=/no/such/", kWithoutSearch);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::filesystem::create_directory(path("evil"));
  write_all(path("evil/stdint.h"), "#error not this one\n");
  const ProcessResult shadowed = pil_after("CPATH=" + path("evil"), kWithoutSearch);
  EXPECT_EQ(shadowed.exit_code, 0) << shadowed.err;
}

TEST_F(Pil, ALinkInTheBuildDirectoryIsNotFollowed) {
  std::filesystem::create_directory(path("links"));
  write_all(path("precious"), "precious");
  for (const char* name : {"build.log", "pil_memory.elf", "awmr_params.h"}) {
    std::filesystem::create_symlink(path("precious"), path("links/" + std::string(name)));
  }
  const ProcessResult run = pil_after("A=b", "--build-dir " + path("links"));
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, HasSubstr("symbolic link"));
  EXPECT_EQ(read_all(path("precious")), "precious");
}

TEST_F(Pil, RefusesAMissingOrReadOnlyTmpdir) {
  for (const std::string& place :
       {path("missing"), std::string("/proc"), path("model.json"), std::string("relative")}) {
    const ProcessResult run = pil_after("TMPDIR=" + place, "", "none.json");
    EXPECT_EQ(run.exit_code, 2) << place << run.err;
    EXPECT_THAT(run.err, HasSubstr("error: TMPDIR: ")) << place;
  }
  EXPECT_FALSE(exists("none.json"));
}

TEST_F(Pil, RefusesABuildDirectoryThatLooksLikeAnOption) {
  const ProcessResult run = pil(kC13, "combined", "--build-dir=-x", "none.json");
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_THAT(run.err, HasSubstr("looks like an option"));
  const ProcessResult file =
      pil(kC13, "combined", "--build-dir " + path("model.json") + "/below", "none.json");
  EXPECT_EQ(file.exit_code, 2) << file.err;
  const ProcessResult kernel = pil(kC13, "combined", "--build-dir /proc/below", "none.json");
  EXPECT_EQ(kernel.exit_code, 2) << kernel.err;
}

TEST_F(Pil, RefusesASampleTimeBeyondTheTimer) {
  Json model = Json::parse(read_all(path("model.json")));
  for (const double sample_time_s : {0.033, 0.05, 4e-7}) {
    model["vehicle"]["sample_time_s"] = sample_time_s;
    write_all(path("slow.json"), model.dump());
    const ProcessResult run = pil_on("slow.json", "gains.json", kC13, "combined", "", "none.json");
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr("slow.json:/vehicle/sample_time_s"));
    EXPECT_THAT(run.err, Not(HasSubstr("static_assert")));
  }
}

TEST_F(Pil, TwoRunsGiveTheSameBytesAndTheRealTimeFactorIsOnStdoutOnly) {
  const std::string c13 = shortened(kC13, 5.0);
  const ProcessResult first = pil(c13, "combined", kShortSearch, "first.json");
  const ProcessResult second = pil(c13, "combined", kShortSearch, "second.json");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(first.out, HasSubstr(" times real time"));
  EXPECT_EQ(read_all(path("first.json")), read_all(path("second.json")));
  EXPECT_FALSE(result("first.json").contains("real_time_factor"));
}

TEST_F(Pil, ASignalLeavesNoFolderBehind) {
  std::filesystem::create_directory(path("tmp"));
  // Sends a signal after several delays: before the compiler starts, while it runs, and during the
  // emulation, which takes seconds.
  for (const char* signal : {"TERM", "INT", "HUP"}) {
    for (const char* after_s : {"0.05", "0.3", "1.0"}) {
      // All signals have the same handler, so only one signal is tested with every delay.
      if (signal != std::string("TERM") && after_s != std::string("0.3")) continue;
      const ProcessResult run = run_process(
          "export TMPDIR=" + path("tmp") + "; timeout --preserve-status --signal=" + signal + " " +
              after_s + " " + AWMR_PROGRAM + " pil --model " + path("model.json") + " --gains " +
              path("gains.json") + " --scenario " + kC8 + " --mode combined -o " + path("cut.json"),
          AWMR_SOURCE_DIR);
      EXPECT_NE(run.exit_code, 3) << run.err;
      EXPECT_EQ(run.err, "") << signal << " after " << after_s << " s";
      EXPECT_EQ(entries("tmp"), 0u) << signal << " after " << after_s << " s";
    }
  }
}

TEST_F(Pil, RemovesTheFolderOfAKilledRun) {
  std::filesystem::create_directory(path("left"));
  const std::string killed = "timeout --signal=KILL 1 " + std::string(AWMR_PROGRAM);
  const std::string run_c8 = " pil --model " + path("model.json") + " --gains " +
                             path("gains.json") + " --scenario " + kC8 + " --mode combined -o " +
                             path("cut.json");
  for (int i = 0; i < 5 && entries("left") == 0; ++i) {
    run_process("export TMPDIR=" + path("left") + "; " + killed + run_c8, AWMR_SOURCE_DIR);
  }
  ASSERT_GT(entries("left"), 0u);
  // These must not be removed, because they are not left by a killed run: another name, no number
  // in the name, a link, a locked folder.
  for (const char* name : {"other", "awmr-pil-abc", "awmr-pil-1-locked"}) {
    std::filesystem::create_directory(path("left/" + std::string(name)));
  }
  std::filesystem::create_directory_symlink(path("left/other"), path("left/awmr-pil-2-linked"));
  const ProcessResult next = run_process(
      "exec 9<" + path("left/awmr-pil-1-locked") +
          " && flock -n 9 && export TMPDIR=" + path("left") + " && " + AWMR_PROGRAM +
          " pil --model " + path("model.json") + " --gains " + path("gains.json") + " --scenario " +
          brief() + " --mode combined" + kWithoutSearch + " -o " + path("next.json"),
      AWMR_SOURCE_DIR);
  ASSERT_EQ(next.exit_code, 0) << next.err;
  EXPECT_EQ(entries("left"), 4u);
}

TEST_F(Pil, RefusesBoundsThatAreNotNumbers) {
  for (const char* option :
       {"--difference-max nan", "--heading-max-deg nan", "--cycles-max -1", "--heading-max-deg inf",
        "--flash-max 1e3", "--ram-max 0", "--hostile-steps -1", "--hostile-steps 1e9"}) {
    EXPECT_EQ(pil(kC13, "combined", option, "none.json").exit_code, 2) << option;
  }
}

TEST_F(Pil, MoreWaypointsThanTheFirmwareHoldsAreRefusedWithTheirPlace) {
  Json scenario = Json::parse(read_all(std::string(AWMR_SOURCE_DIR) + "/" + kC8));
  scenario["guidance"]["points_m"] = Json::array();
  for (int i = 0; i < 17; ++i) scenario["guidance"]["points_m"].push_back({100.0 + i, 0.0});
  write_all(path("many.json"), scenario.dump());
  const ProcessResult run = pil(path("many.json"), "combined", "", "none.json");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("many.json:/guidance/points_m"));
}

TEST_F(Pil, SpeaksToABoardOnASerialPort) {
  const std::string build = "--link uart --build-dir " + path("board") + kWithoutSearch;
  ASSERT_EQ(pil(brief(), "steering", build).exit_code, 0);
  // The board is an emulated chip behind a pseudo-terminal. It ends when the port is closed.
  const ProcessResult run = run_process(
      std::string(AWMR_PIL_PROGRAM) + " serve " + path("board") + "/pil_uart.elf >" + path("tty") +
      " & board=$!; while ! [ -s " + path("tty") + " ]; do sleep 0.05; done; " + AWMR_PROGRAM +
      " pil --model " + path("model.json") + " --gains " + path("gains.json") + " --scenario " +
      brief() + " --mode steering --link uart --port $(cat " + path("tty") + ") -o " +
      path("port.json") + "; code=$?; kill $board 2>/dev/null; exit $code");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_EQ(largest(result("port.json")["difference"]), 0.0);
  EXPECT_TRUE(result("port.json")["stack_bytes"].is_null());
  EXPECT_TRUE(result("port.json")["cycles_bound"].is_null());
}

}  // namespace
}  // namespace awmr::testing
