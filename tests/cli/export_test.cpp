/// Files of `awmr export` as read by their target programs.
#include <gmock/gmock.h>

#include "cli/program.h"

namespace awmr::testing::export_test {
namespace {

using ::testing::HasSubstr;

class Export : public ::testing::Test {
 protected:
  void SetUp() override {
    const ProcessResult identified = awmr(
        "identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
        "--coastdown "
        "datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
        path("model.json"));
    ASSERT_EQ(identified.exit_code, 0) << identified.err;
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  ProcessResult write(const std::string& format, const std::string& name) const {
    return awmr("export --model " + path("model.json") + " --format " + format + " -o " +
                path(name));
  }
  ProcessResult python(const std::string& script) const {
    write_all(path("script.py"), script);
    return run_process("/usr/bin/python3 script.py", directory_.path());
  }
  TemporaryDirectory directory_;
};

TEST_F(Export, PythonImportsTheModule) {
  ASSERT_EQ(write("python", "rover.py").exit_code, 0);
  const ProcessResult result = python(
      "import rover\n"
      "lo, hi = rover.CI95['SURGE_ALPHA']\n"
      "assert lo < rover.SURGE_ALPHA < hi and rover.STD_ERROR['SURGE_ALPHA'] > 0\n"
      "assert rover.MASS_KG == 37.0 and rover.WHEEL_FORCE_MIN == -1.0\n"
      "assert all(isinstance(v, float) for k, v in vars(rover).items() if k.endswith('_M'))\n"
      "print(rover.SI_MAX_WHEEL_FORCE)\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(Export, EveryRos2ParameterIsADouble) {
  ASSERT_EQ(write("ros2", "rover.yaml").exit_code, 0);
  const ProcessResult result = python(
      "import sys\n"
      "try:\n    import yaml\nexcept ImportError:\n    sys.exit(77)\n"
      "parameters = yaml.safe_load(open('rover.yaml'))['/**']['ros__parameters']\n"
      "assert len(parameters) > 15, parameters\n"
      "assert all(type(v) is float for v in parameters.values()), parameters\n"
      "assert parameters['front_axle_m'] == 0.35\n");
  if (result.exit_code == 77) GTEST_SKIP() << "python3-yaml is not installed";
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(Export, AutopilotsFilesHaveNothingButParametersAndComments) {
  ASSERT_EQ(write("ardupilot", "rover.param").exit_code, 0);
  ASSERT_EQ(write("px4", "rover.params").exit_code, 0);
  const ProcessResult result = python(
      "import re\n"
      "for name, form in (('rover.param', r'[A-Z_]{1,16},-?[0-9.]+$'),\n"
      "                   ('rover.params', r'1\\t1\\t[A-Z_]{1,16}\\t-?[0-9.]+\\t9$')):\n"
      "    lines = [l for l in open(name, encoding='ascii') if not l.startswith('#')]\n"
      "    assert len(lines) >= 3, lines\n"
      "    assert all(re.match(form, l) for l in lines), lines\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_all(path("rover.params")),
              HasSubstr("extrapolated: the trials reach only tau_speed 2"));
}

TEST_F(Export, TheSameInputsMakeTheSameBytesAndNameTheirHashes) {
  for (const char* format : {"ros2", "matlab", "python", "csv", "ardupilot", "px4"}) {
    ASSERT_EQ(write(format, "a").exit_code, 0) << format;
    ASSERT_EQ(write(format, "b").exit_code, 0) << format;
    EXPECT_EQ(read_all(path("a")), read_all(path("b"))) << format;
    EXPECT_THAT(read_all(path("a")), HasSubstr("from model.json, SHA-256 ")) << format;
  }
}

}  // namespace
}  // namespace awmr::testing::export_test
