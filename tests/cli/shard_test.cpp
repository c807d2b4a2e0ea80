/// Shards of compare and recover on the command line: merging them, and refusing shards that do not
/// belong together.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>

#include "cli/program.h"

namespace awmr::testing::shard_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ShardsOfCommands : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    static const TemporaryDirectory kept;
    model_ = (kept.path() / "model.json").string();
    gains_ = (kept.path() / "gains.json").string();
    write_all(gains_, R"({"heading": {"lambda": 3, "mu": 50, "epsilon": 12},
                          "speed": {"mu": 5, "epsilon": 1.2}})");
    expect_done(
        awmr("identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
             "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv "
             "-o " +
             model_));
  }
  static void expect_done(const ProcessResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  std::string recover(const std::string& words) const {
    return fmt::format("recover --model {} --runs 5 {}", model_, words);
  }
  std::string compare(const std::string& words) const {
    return fmt::format(
        "compare --model {} --gains {} --samples 3 {} --scenario "
        "configs/paper/scenarios/c3_heading_steps.json",
        model_, gains_, words);
  }
  /// Runs the command as two shards in separate directories.
  std::string parts_of(const std::string& name, const std::string& first,
                       const std::string& second) {
    expect_done(awmr(fmt::format("{} -o {}", first, path(name + "1"))));
    expect_done(awmr(fmt::format("{} -o {}", second, path(name + "2"))));
    return fmt::format("{} {}", path(name + "1"), path(name + "2"));
  }

  TemporaryDirectory directory_;
  inline static std::string model_, gains_;
};

TEST_F(ShardsOfCommands, OfARecoveryAreMergedToTheBytesOfASingleRun) {
  expect_done(awmr(recover("-o " + path("whole.json"))));
  const std::string parts = parts_of("part", recover("--shard 1/2"), recover("--shard 2/2"));
  const ProcessResult merged = awmr(fmt::format("merge {} -o {}", parts, path("merged")));
  expect_done(merged);
  EXPECT_THAT(merged.out, HasSubstr("surge.alpha"));
  EXPECT_EQ(read_all(path("merged/recover.json")), read_all(path("whole.json")));
  // A single shard is a valid shard too.
  expect_done(awmr(recover("--shard 1/1 -o " + path("only"))));
  expect_done(awmr(fmt::format("merge {} -o {}", path("only"), path("merged_only"))));
  EXPECT_EQ(read_all(path("merged_only/recover.json")), read_all(path("whole.json")));
}

TEST_F(ShardsOfCommands, OfTheLargestSeedAreMergedWithTheHeadingRateLimit) {
  const std::string seed = "--seed 18446744073709551615 ";
  const std::string parts =
      parts_of("large", compare(seed + "--shard 1/2"), compare(seed + "--shard 2/2"));
  const ProcessResult merged = awmr(fmt::format("merge {} -o {}", parts, path("merged")));
  expect_done(merged);
  EXPECT_THAT(merged.out,
              HasSubstr("heading commands limited to the highest yaw rate of the turning trials"));
}

TEST_F(ShardsOfCommands, OfDifferentKindsAreNotMixed) {
  const std::string mixed = parts_of("mixed", recover("--shard 1/2"), compare("--shard 2/2"));
  for (const std::string& parts : {mixed, path("mixed2") + " " + path("mixed1")}) {
    const ProcessResult merged = awmr(fmt::format("merge {} -o {}", parts, path("merged")));
    EXPECT_EQ(merged.exit_code, 2);
    EXPECT_THAT(merged.err, HasSubstr("shard.json:/schema: expected \"awmr."));
    EXPECT_THAT(merged.err, HasSubstr("another kind of job"));
    EXPECT_FALSE(fs::exists(path("merged")));
  }
}

TEST_F(ShardsOfCommands, OfAProcessorThatRoundsDifferentlyAreNotMixed) {
  // Makes the C library behave as on a processor without fused multiply-add, whose results differ.
  const std::string other = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4 ";
  expect_done(awmr(recover("--shard 1/2 -o " + path("1"))));
  expect_done(run_process(other + AWMR_PROGRAM + " " + recover("--shard 2/2 -o " + path("2")),
                          AWMR_SOURCE_DIR));
  const ProcessResult merged =
      awmr(fmt::format("merge {} {} -o {}", path("1"), path("2"), path("merged")));
  if (merged.exit_code == 0) GTEST_SKIP() << "this processor has no fused multiply-add";
  EXPECT_EQ(merged.exit_code, 2);
  EXPECT_THAT(merged.err, HasSubstr("their numbers are rounded differently"));
}

TEST_F(ShardsOfCommands, MergeRefusesParametersThatNoRunGives) {
  const std::string requested = "--fit steering.time_constant_s ";
  const ProcessResult whole = awmr(recover(requested));
  EXPECT_EQ(whole.exit_code, 1);
  const std::string parts =
      parts_of("asked", recover(requested + "--shard 1/2"), recover(requested + "--shard 2/2"));
  const ProcessResult merged = awmr(fmt::format("merge {} -o {}", parts, path("merged")));
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_EQ(merged.err, whole.err);
  EXPECT_FALSE(fs::exists(path("merged")));
}

}  // namespace
}  // namespace awmr::testing::shard_test
