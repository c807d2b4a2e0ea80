/// Numeric options with invalid values: exit code 2, the option's name, and no crash.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "cli/program.h"

namespace awmr::testing::bad_number_test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

struct NumericOption {
  const char* command;
  const char* option;
  bool whole;
};

constexpr NumericOption kOptions[] = {
    {"identify", "--starts", true},
    {"identify", "--bootstrap", true},
    {"identify", "--seed", true},
    {"identify", "--threads", true},
    {"recover", "--runs", true},
    {"recover", "--seed", true},
    {"recover", "--threads", true},
    {"recover", "--speed-noise", false},
    {"recover", "--correlation", false},
    {"recover", "--duration", false},
    {"recover", "--rate", false},
    {"suggest", "--repeats", true},
    {"validate", "--tolerance", false},
    {"validate", "--horizon", false},
    {"validate", "--log-tolerance", false},
    {"compare", "--samples", true},
    {"compare", "--seed", true},
    {"compare", "--threads", true},
    {"live", "--every", false},
    {"live", "--budget", false},
    {"live", "--enough", false},
    {"live", "--duration", false},
    {"live", "--idle", false},
    {"live", "--baud", true},
    {"emit", "--table-error", false},
    {"emit", "--heading-timeout-ms", true},
    {"emit", "--speed-timeout-ms", true},
    {"emit", "--command-timeout-ms", true},
    {"emit", "--step-timeout-ms", true},
    {"pil", "--cycles-max", true},
    {"pil", "--flash-max", true},
    {"pil", "--ram-max", true},
    {"pil", "--baud", true},
    {"pil", "--difference-max", false},
    {"pil", "--heading-max-deg", false},
};

TEST(BadNumber, IsRefusedByEveryNumericOption) {
  for (const NumericOption& option : kOptions) {
    std::vector<std::string> texts{"nan", "inf",   "-inf", "''",
                                   "1x",  "1e300", "-1",   "100000000000000000000000"};
    if (option.whole) texts.insert(texts.end(), {"1.5", "1e2"});
    for (const std::string& text : texts) {
      const ProcessResult result =
          awmr(std::string(option.command) + " " + option.option + "=" + text);
      EXPECT_EQ(result.exit_code, 2) << option.command << " " << option.option << "=" << text;
      EXPECT_THAT(result.err, HasSubstr(option.option)) << option.command << " " << text;
    }
  }
}

/// Options whose value is a time on a log's clock: negative times are accepted, other invalid
/// numbers refused.
TEST(BadNumber, IsRefusedAsATime) {
  const std::string files =
      "identify --vehicle configs/paper/vehicle.json "
      "--log datasets/synthetic/drive_1.csv -o /dev/null ";
  for (const char* option :
       {"--from=nan", "--until=1x", "--from=1e13", "--exclude=5", "--exclude=5:", "--exclude=5:5",
        "--exclude=:5", "--exclude=1:nan", "--from=9 --until=3", "--from=1e6"}) {
    const ProcessResult result = awmr(files + option);
    EXPECT_EQ(result.exit_code, 2) << option;
    const std::string name = std::string(option).substr(0, std::string(option).find('='));
    EXPECT_THAT(result.err, AnyOf(HasSubstr(name), HasSubstr("--until"))) << option;
  }
}

TEST(BadNumber, IsRefusedAsATimeOfAProject) {
  TemporaryDirectory directory;
  const std::string root = AWMR_SOURCE_DIR;
  const auto check = [&](const std::string& part) {
    const std::filesystem::path project = directory.path() / "project.json";
    write_all(project, R"({"schema": "awmr.project/1", "vehicle": ")" + root +
                           R"(/configs/paper/vehicle.json", "trials": {"logs": [")" + root +
                           R"(/datasets/synthetic/drive_1.csv"]}, "identify": {)" + part +
                           R"(}, "compare": {"scenarios": [")" + root +
                           R"(/configs/paper/scenarios/c3_heading_steps.json"]}})");
    return awmr("check " + project.string());
  };
  EXPECT_EQ(check(R"("from_s": 2, "until_s": 12, "exclude": ["5:6"])").exit_code, 0);
  EXPECT_THAT(check(R"("from_s": 1e6)").err, HasSubstr("no row is left"));
  EXPECT_THAT(check(R"("from_s": 9, "until_s": 3)").err, HasSubstr("/identify/until_s"));
  EXPECT_THAT(check(R"("exclude": ["5"])").err, HasSubstr("/identify/exclude"));
}

TEST(BadNumber, TheHelpShowsTheRange) {
  EXPECT_THAT(awmr("recover --help").out, HasSubstr("in [2, 1000000]"));
  EXPECT_THAT(awmr("pil --help").out, HasSubstr("in [0, 360]"));
}

TEST(BadNumber, ALogOfNoRowsOrWithoutEndIsNotSimulated) {
  TemporaryDirectory directory;
  const std::string model = (directory.path() / "model.json").string();
  ASSERT_EQ(awmr("identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
                 "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv "
                 "-o " +
                 model)
                .exit_code,
            0);
  for (const char* drive : {"--duration 1e-9", "--duration 1e300", "--rate nan", "--rate 1e300",
                            "--duration 1 --rate 1", "--rate 1e-300"}) {
    const ProcessResult result = awmr("recover --plan log --runs 2 --model " + model + " " + drive);
    EXPECT_EQ(result.exit_code, 2) << drive;
    EXPECT_THAT(result.err, HasSubstr("error:")) << drive;
  }
}

}  // namespace
}  // namespace awmr::testing::bad_number_test
