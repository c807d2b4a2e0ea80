/// Ctrl-C during compare, tested on the program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "support/process.h"

namespace awmr::testing {
namespace {

TEST(Interrupt, LeavesTheFilesOfASmallerComparison) {
  const TemporaryDirectory directory;
  const std::string out = directory.path().string();
  const std::string program = AWMR_PROGRAM;
  const auto in_source = [](const std::string& line) { return run_process(line, AWMR_SOURCE_DIR); };
  ASSERT_EQ(in_source(program +
                      " identify --vehicle configs/paper/vehicle.json --surge "
                      "datasets/paper/surge.csv --coastdown datasets/paper/coastdown.csv "
                      "--turning datasets/paper/turning.csv -o " +
                      out + "/model.json")
                .exit_code,
            0);
  write_all(directory.path() / "gains.json",
            R"({"schema": "awmr.gains/1", "heading": {"lambda": 3, "mu": 50, "epsilon": 12},)"
            R"( "speed": {"mu": 5, "epsilon": 1.2}})");
  const auto compare = [&](const std::string& samples, const std::string& to) {
    return program + " compare --model " + out + "/model.json --gains " + out +
           "/gains.json --scenario configs/paper/scenarios/c3_heading_steps.json --seed 5 "
           "--samples " +
           samples + " -o " + out + "/" + to;
  };
  // The comparison needs far more time than it gets, so that the signal interrupts it. It gets more
  // time if a busy machine has not started it, or has not finished a sample, yet.
  ProcessResult stopped;
  for (const char* seconds : {"1", "2", "4", "8", "16"}) {
    stopped =
        in_source(fmt::format("timeout --signal=INT {} {}", seconds, compare("50000", "part")));
    const bool has_runs = stopped.err.find("finished runs are in") != std::string::npos &&
                          stopped.err.find("stopped: 0 finished") == std::string::npos;
    if (has_runs) break;
  }
  EXPECT_NE(stopped.exit_code, 0);
  EXPECT_NE(stopped.err.find("finished runs are in"), std::string::npos) << stopped.err;
  // With --json, stdout and stderr have nothing but JSON.
  const auto json =
      in_source("timeout --signal=INT 1 " + compare("50000", "as_json") + " --threads 1 --json");
  EXPECT_NE(json.exit_code, 0);
  EXPECT_EQ(json.out + json.err, "");
  // A part is not written, because it must be run again.
  ProcessResult part;
  for (const char* seconds : {"1", "2", "4", "8", "16"}) {
    part = in_source(fmt::format("timeout --signal=INT {} {} --threads 1 --shard 1/2", seconds,
                                 compare("50000", "shard")));
    if (!part.err.empty()) break;
  }
  EXPECT_NE(part.exit_code, 0);
  EXPECT_NE(part.err.find("nothing is written"), std::string::npos) << part.err;
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "shard"));
  // The first rows equal those of a comparison with fewer samples.
  EXPECT_EQ(in_source(compare("12", "whole")).exit_code, 0);
  const std::string whole = read_all(directory.path() / "whole/comparison.csv");
  const std::string rows = whole.substr(0, whole.find(",steering,"));
  const std::string first = rows.substr(0, rows.rfind('\n') + 1);
  EXPECT_EQ(read_all(directory.path() / "part/comparison.csv").substr(0, first.size()), first);
}

}  // namespace
}  // namespace awmr::testing
