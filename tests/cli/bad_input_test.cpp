/// User errors: exit code, place and remedy are reported and no output file is written.
#include <gmock/gmock.h>

#include "cli/program.h"

namespace awmr::testing::bad_input_test {
namespace {

using ::testing::HasSubstr;

class BadInput : public ::testing::Test {
 protected:
  /// Identifies from a surge table with this content.
  ProcessResult identify_surge(const std::string& csv) {
    write_all(directory_.path() / "surge.csv", csv);
    return awmr("identify --vehicle configs/paper/vehicle.json --surge " + surge() + " -o " +
                output().string());
  }
  std::string surge() const { return (directory_.path() / "surge.csv").string(); }
  std::filesystem::path output() const { return directory_.path() / "model.json"; }
  void expect_refused_input(const ProcessResult& result, const std::string& place,
                            const std::string& words) {
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("error: " + place));
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_FALSE(std::filesystem::exists(output()));
  }
  TemporaryDirectory directory_;
};

TEST_F(BadInput, MissingFileIsNamed) {
  const ProcessResult result = awmr("identify --vehicle configs/paper/vehicle.json --surge " +
                                    surge() + " -o " + output().string());
  expect_refused_input(result, surge(), "");
}

TEST_F(BadInput, MissingColumnIsNamedWithTheNearestOne) {
  expect_refused_input(identify_surge("tau_sped,speed_mps\n1,0.5\n2,1.2\n"), surge(), "tau_speed");
}

TEST_F(BadInput, TextInANumberHasLineAndColumn) {
  expect_refused_input(identify_surge("tau_speed,speed_mps\n1,0.5\n2,fast\n"),
                       surge() + ":3:3:", "fast");
}

TEST_F(BadInput, NegativeSpeedHasLineAndColumn) {
  expect_refused_input(identify_surge("tau_speed,speed_mps\n1,0.5\n2,-1.2\n"),
                       surge() + ":3:3:", "-1.2");
}

TEST_F(BadInput, UnknownJsonKeyIsNamedByPointer) {
  std::string vehicle = read_all(std::string(AWMR_SOURCE_DIR) + "/configs/paper/vehicle.json");
  vehicle.replace(vehicle.find("mass_kg"), 7, "mass_kq");
  const std::string path = (directory_.path() / "vehicle.json").string();
  write_all(path, vehicle);
  const ProcessResult result = awmr("identify --vehicle " + path +
                                    " --surge datasets/paper/surge.csv -o " + output().string());
  expect_refused_input(result, path + ":/mass_kq:", "mass_kg");
}

TEST_F(BadInput, OneUsableRowIsRefusedWithTheMissingTrial) {
  const ProcessResult result = identify_surge("tau_speed,speed_mps\n1,0.5\n");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("not-identifiable"));
  EXPECT_THAT(result.err, HasSubstr("surge.beta"));
}

TEST_F(BadInput, EqualThrustsAreRefusedWithTheMissingTrial) {
  const ProcessResult result = identify_surge("tau_speed,speed_mps\n1,0.5\n1,0.52\n1,0.49\n");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("not-identifiable"));
}

TEST_F(BadInput, AFailedCommandLeavesAnExistingOutputAsItWas) {
  write_all(output(), "precious");
  EXPECT_EQ(identify_surge("tau_speed,speed_mps\n1,nan\n").exit_code, 2);
  EXPECT_EQ(read_all(output()), "precious");
}

TEST_F(BadInput, UnknownOptionAndCommandExitWithTwo) {
  EXPECT_EQ(awmr("identify --frobnicate").exit_code, 2);
  EXPECT_EQ(awmr("frobnicate").exit_code, 2);
  EXPECT_EQ(awmr("").exit_code, 2);
}

TEST_F(BadInput, HelpOfAnUnknownCommandExitsWithTwo) {
  for (const char* line : {"bogus --help", "bogus --version", "bogus -h"}) {
    const ProcessResult result = awmr(line);
    EXPECT_EQ(result.exit_code, 2) << line;
    EXPECT_THAT(result.err, HasSubstr("'bogus'")) << line;
    EXPECT_THAT(result.err, HasSubstr("[usage]")) << line;
    EXPECT_EQ(result.out, "") << line;
  }
  EXPECT_EQ(awmr("identify --help").exit_code, 0);
  EXPECT_EQ(awmr("--help").exit_code, 0);
}

TEST_F(BadInput, ADirectoryInPlaceOfAFileIsNamed) {
  const TemporaryDirectory directory;
  write_all(directory.path() / "one.csv", "t_s,a\n0,1\n1,2\n");
  const std::string place = directory.path().string();
  const std::string vehicle = "configs/paper/vehicle.json";
  for (const std::string& line :
       {"identify --vehicle " + vehicle + " --surge " + place + " -o m.json",
        "identify --vehicle " + vehicle + " --turning " + place + " -o m.json",
        "identify --vehicle " + vehicle + " --log " + place + " -o m.json",
        "identify --vehicle " + vehicle + " --coastdown " + place + " -o m.json",
        "identify --vehicle " + place + " --surge datasets/paper/surge.csv -o m.json",
        "simulate --model " + place + " --scenario x --mode combined -o r.csv"}) {
    const ProcessResult result = awmr(line);
    EXPECT_EQ(result.exit_code, 2) << line;
    EXPECT_THAT(result.err, HasSubstr("error: " + place)) << line;
    EXPECT_THAT(result.err, ::testing::ContainsRegex("this (is a directory|directory is)")) << line;
  }
}

TEST_F(BadInput, RunIntoAFileNamesTheFile) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "FILE").string();
  write_all(file, "kept");
  const ProcessResult result = awmr("run configs/paper/project.json -o " + file);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("error: " + file + ": this is a file"));
  EXPECT_THAT(result.err, HasSubstr("[wrong-file]"));
  EXPECT_EQ(read_all(file), "kept");
}

TEST_F(BadInput, WithoutArgumentsTheCommandsAreShown) {
  const ProcessResult result = awmr("");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("identify"));
  EXPECT_THAT(result.err, HasSubstr("awmr init my_rover"));
}

TEST_F(BadInput, ALaterStepNamesTheMissingParameterAndItsTrial) {
  ASSERT_EQ(
      awmr("identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv -o " +
           output().string())
          .exit_code,
      0);
  const std::string gains = (directory_.path() / "gains.json").string();
  const ProcessResult result = awmr("tune --model " + output().string() + " -o " + gains);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("yaw.alpha"));
  EXPECT_FALSE(std::filesystem::exists(gains));
}

TEST(Help, EveryCommandHasAnExample) {
  for (const char* command : {"init", "check", "run", "identify", "validate", "tune", "simulate",
                              "compare", "emit", "export", "report"}) {
    const ProcessResult result = awmr(std::string(command) + " --help");
    EXPECT_EQ(result.exit_code, 0) << command;
    EXPECT_THAT(result.out, HasSubstr("Example:")) << command;
    EXPECT_EQ(awmr(std::string(command) + " --version").exit_code, 0) << command;
  }
}

}  // namespace
}  // namespace awmr::testing::bad_input_test
