/// Protection against data loss and against wrong provenance of inputs.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace awmr::testing::data_loss_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

class DataLoss : public ::testing::Test {
 protected:
  DataLoss() {
    fs::copy(std::string(AWMR_SOURCE_DIR) + "/configs/paper/vehicle.json", path("vehicle.json"));
    fs::copy(std::string(AWMR_SOURCE_DIR) + "/datasets/paper/surge.csv", path("surge.csv"));
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  std::string text(const std::string& name) const { return read_all(path(name)); }
  /// Identifies from the surge table in this directory, given by any path.
  ProcessResult identify(const std::string& surge, const std::string& output,
                         const std::string& before = "", const std::string& after = "") {
    return awmr_after(before, fmt::format("identify --vehicle {} --surge {} -o {} {}",
                                          path("vehicle.json"), surge, output, after));
  }
  ProcessResult awmr_after(const std::string& before, const std::string& arguments) {
    return run_process(fmt::format("{}{} {}", before, AWMR_PROGRAM, arguments), AWMR_SOURCE_DIR);
  }
  TemporaryDirectory directory_;
};

TEST_F(DataLoss, RefusesOutputEqualToInput) {
  const std::string surge = text("surge.csv");
  fs::create_symlink("surge.csv", path("link"));
  for (const char* output : {"surge.csv", "link", "./link", "../surge.csv"}) {
    fs::create_directory(path("d"));
    const std::string typed =
        output[0] == '.' && output[1] == '.' ? path("d/") + output : path(output);
    const ProcessResult result = identify(path("surge.csv"), typed);
    EXPECT_EQ(result.exit_code, 2) << output;
    EXPECT_THAT(result.err, HasSubstr("it is the input"));
    EXPECT_EQ(text("surge.csv"), surge);
  }
}

TEST_F(DataLoss, RefusesToReplaceAReadOnlyFile) {
  write_all(path("model.json"), "precious");
  ASSERT_EQ(::chmod(path("model.json").c_str(), 0444), 0);
  EXPECT_EQ(identify(path("surge.csv"), path("model.json")).exit_code, 2);
  EXPECT_EQ(text("model.json"), "precious");
}

TEST_F(DataLoss, FullStandardOutputExitsWith2) {
  const ProcessResult result =
      identify(path("surge.csv"), path("model.json"), "", "--fit surge.alpha >/dev/full");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("cannot write to standard output"));
  EXPECT_EQ(awmr("--help >/dev/full").exit_code, 2);
  EXPECT_EQ(awmr("identify --help >/dev/full").exit_code, 2);
}

TEST_F(DataLoss, ReportsTheFileSizeLimitAndLeavesNoTemporaryFile) {
  const ProcessResult result = identify(path("surge.csv"), path("model.json"), "ulimit -f 1; ");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("File too large"));
  for (const auto& entry : fs::directory_iterator(directory_.path())) {
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr(".awmr")));
  }
}

TEST_F(DataLoss, HashesAPipeLikeItsFile) {
  ASSERT_EQ(identify(path("surge.csv"), path("file.json"), "", "--fit surge.alpha").exit_code, 0);
  ASSERT_EQ(identify("/dev/stdin", path("pipe.json"), fmt::format("cat {} | ", path("surge.csv")),
                     "--fit surge.alpha")
                .exit_code,
            0);
  const auto hash = [&](const char* name) {
    return nlohmann::json::parse(text(name))["inputs"][1]["sha256"].get<std::string>();
  };
  EXPECT_EQ(hash("pipe.json"), hash("file.json"));
}

TEST_F(DataLoss, ModelDoesNotDependOnTheSpellingOfAPath) {
  fs::create_directory(path("d"));
  const std::string disagreeing =
      "wheel_force,tau_speed,speed_mps\n0.25,1,0.5\n0.5,2.2,1.1\n0.75,3,1.7\n";
  write_all(path("rows.csv"), disagreeing);
  const std::string fit = "--fit surge.alpha,surge.beta";
  ASSERT_EQ(identify(path("rows.csv"), path("a.json"), "", fit).exit_code, 0);
  ASSERT_EQ(identify(path("d/../././rows.csv"), path("b.json"), "", fit).exit_code, 0);
  EXPECT_EQ(text("a.json"), text("b.json"));
  EXPECT_THAT(text("a.json"), HasSubstr("tau-speed-mismatch"));
  EXPECT_THAT(text("a.json"), Not(HasSubstr(directory_.path().string())));
}

TEST_F(DataLoss, RefusesAnEndlessInput) {
  const ProcessResult result = awmr(fmt::format("identify --vehicle /dev/zero --surge {} -o {}",
                                                path("surge.csv"), path("model.json")));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("longer than 64 MiB"));
}

TEST_F(DataLoss, EscapesControlCharactersOfNames) {
  std::string vehicle = text("vehicle.json");
  const std::size_t name = vehicle.find("\"name\": \"") + 9;
  vehicle.insert(name, "\\u001b[2J\\u009b");
  write_all(path("vehicle.json"), vehicle);
  const ProcessResult result = identify(path("surge.csv"), path("model.json"));
  EXPECT_THAT(result.out, HasSubstr("\\x1b[2J"));
  EXPECT_THAT(result.out + result.err, Not(HasSubstr("\x1B")));
  write_all(path("a\x1B[2J.csv"), "x\n");
  EXPECT_THAT(identify(fmt::format("'{}'", path("a\x1B[2J.csv")), path("model.json")).err,
              Not(HasSubstr("\x1B")));
}

TEST_F(DataLoss, ShortensLongCellsInMessages) {
  write_all(path("surge.csv"),
            fmt::format("tau_speed,speed_mps\n1,{}\n", std::string(10'000'000, 'x')));
  const ProcessResult result = identify(path("surge.csv"), path("model.json"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_LT(result.err.size(), 5000U);
  write_all(path("surge.csv"), std::string(10'000'000, 'x') + ",speed_mps\n1,2\n");
  EXPECT_LT(identify(path("surge.csv"), path("model.json")).err.size(), 5000U);
}

TEST_F(DataLoss, RefusesTwoScenariosWithOneFileName) {
  fs::create_directory(path("d"));
  const std::string scenario =
      std::string(AWMR_SOURCE_DIR) + "/configs/paper/scenarios/c3_heading_steps.json";
  fs::copy(scenario, path("s.json"));
  fs::copy(scenario, path("d/s.json"));
  write_all(path("project.json"),
            R"({"vehicle": "vehicle.json", "trials": {"surge": "surge.csv"},
                "compare": {"scenarios": ["s.json", "d/s.json", "missing.json"]}})");
  const ProcessResult result = awmr(fmt::format("run {} -o {}", path("project.json"), path("out")));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("two scenarios are called s,"));
  EXPECT_THAT(result.err, HasSubstr("missing.json"));  // reported before any step
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(DataLoss, ChecksTheTuneFileBeforeIdentifying) {
  fs::copy(std::string(AWMR_SOURCE_DIR) + "/configs/paper/scenarios/c3_heading_steps.json",
           path("s.json"));
  write_all(path("tune.json"), R"({"scenarios": ["missing.json"]})");
  write_all(path("project.json"),
            R"({"vehicle": "vehicle.json", "trials": {"surge": "surge.csv"}, "tune": "tune.json",
                "compare": {"scenarios": ["s.json"]}})");
  const ProcessResult result = awmr(fmt::format("run {} -o {}", path("project.json"), path("out")));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("missing.json"));
  EXPECT_FALSE(fs::exists(path("out")));
}

/// Runs `awmr COMMAND` and stops it after `seconds` if it hangs: exit code 124.
ProcessResult within_seconds(int seconds, const std::string& command) {
  return run_process(fmt::format("timeout {} {} {}", seconds, AWMR_PROGRAM, command),
                     AWMR_SOURCE_DIR);
}

TEST_F(DataLoss, APipeInAResultsDirectoryIsRefused) {
  ASSERT_EQ(identify(path("surge.csv"), path("model.json"), "", "--fit surge.alpha").exit_code, 0);
  for (const char* name :
       {"gains.json", "validation.json", "comparison.csv", "run_a_combined_tuned.csv",
        "scenario_a.json", "report.html", "model.json", "shard.json"}) {
    const std::string at = path(name);
    const bool is_model = name == std::string("model.json");
    if (is_model) fs::rename(at, path("kept.json"));
    ASSERT_EQ(::mkfifo(at.c_str(), 0600), 0);
    // Another program has the pipe open for writing, but writes nothing.
    const int held = ::open(at.c_str(), O_RDWR | O_CLOEXEC);
    const std::string command = name == std::string("shard.json")
                                    ? "merge " + path(".") + " -o " + path("merged")
                                    : "report " + path(".");
    const ProcessResult result = within_seconds(20, command);
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_THAT(result.err, HasSubstr("this is a pipe or a device")) << name;
    ::close(held);
    fs::remove(at);
    if (is_model) fs::rename(path("kept.json"), at);
  }
}

TEST_F(DataLoss, RefusesOutputsInImpossiblePlaces) {
  ASSERT_EQ(
      awmr("identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
           "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
           path("model.json"))
          .exit_code,
      0);
  fs::create_symlink("loop", path("loop"));
  std::vector<std::string> places{path("loop"), path("loop") + "/d", path(std::string(256, 'n')),
                                  path("surge.csv") + "/d", path("new/") + std::string(256, 'n')};
  if (::geteuid() != 0) {
    fs::create_directory(path("shut"));
    ASSERT_EQ(::chmod(path("shut").c_str(), 0), 0);
    places.push_back(path("shut/d"));
    places.push_back(path("shut/d/e"));
  }
  const std::string model = " --model " + path("model.json");
  write_all(path("gains.json"), R"({"heading": {"lambda": 3, "mu": 50, "epsilon": 12},
                                    "speed": {"mu": 5, "epsilon": 1.2}})");
  const std::string both = model + " --gains " + path("gains.json") +
                           " --scenario configs/paper/scenarios/c3_heading_steps.json";
  for (const std::string& place : places) {
    for (const std::string& command :
         {"init " + place, "init --example " + place, "run configs/paper/project.json -o " + place,
          "compare" + both + " -o " + place,
          "emit" + model + " --gains " + path("gains.json") + " -o " + place,
          "recover" + model + " --runs 4 --shard 1/2 -o " + place, "tune" + model + " -o " + place,
          "schema -o " + place, "man -o " + place, "merge " + place + " -o " + place,
          "report " + place, "check " + place, "suggest" + model + " -o " + place + "/suggest.json",
          "identify --vehicle " + path("vehicle.json") + " --log " + place + " -o " +
              path("x.json")}) {
      const ProcessResult result = within_seconds(60, command);
      EXPECT_EQ(result.exit_code, 2) << command << "\n" << result.err;
      EXPECT_THAT(result.err, HasSubstr("error: ")) << command;
    }
  }
  if (::geteuid() != 0) ::chmod(path("shut").c_str(), 0755);
}

bool has_temporary_file(const fs::path& directory) {
  std::error_code error;
  for (fs::recursive_directory_iterator it(directory, error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().filename().string().find(".awmr-") != std::string::npos) return true;
  }
  return false;
}

/// Runs `awmr init --example OUTPUT`, stops it once `directory` contains a temporary file, sends
/// `signal` and continues it. Returns the signal that ended it; 0: it ended before it was stopped.
int end_while_writing(const fs::path& directory, const std::string& output, int signal) {
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
    std::signal(signal, SIG_DFL);  // the test's shell may have set it to be ignored
    ::execl(AWMR_PROGRAM, AWMR_PROGRAM, "init", "--example", output.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (!has_temporary_file(directory)) continue;
    ::kill(child, SIGSTOP);
    ::waitpid(child, &status, WUNTRACED);
    if (!WIFSTOPPED(status)) break;
    const bool is_writing = has_temporary_file(directory);
    ::kill(child, signal);
    ::kill(child, SIGCONT);
    ::waitpid(child, &status, 0);
    return is_writing && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }
  return 0;
}

TEST_F(DataLoss, ASignalWhileFilesAreWrittenLeavesNoTemporaryFile) {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGQUIT}) {
    int ended_by = 0;
    // Several attempts, because the program may have finished writing before it is stopped.
    for (int attempt = 0; attempt < 100 && ended_by == 0; ++attempt) {
      ended_by = end_while_writing(directory_.path(), path("example"), signal);
      EXPECT_FALSE(has_temporary_file(directory_.path())) << signal;
      fs::remove_all(path("example"));
    }
    EXPECT_EQ(ended_by, signal);
  }
}

}  // namespace
}  // namespace awmr::testing::data_loss_test
