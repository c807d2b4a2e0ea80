/// `awmr init`: the files of a new project, without overwriting anything.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace awmr::testing::init_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Init : public ::testing::Test {
 protected:
  fs::path path(const std::string& name) const { return directory_.path() / "rover" / name; }
  ProcessResult init(const std::string& options = "") const {
    return awmr("init " + path("").string() + options);
  }
  nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(read_all(path(name)));
  }
  TemporaryDirectory directory_;
};

TEST_F(Init, WritesAProjectWithNullForEveryMeasuredValue) {
  const ProcessResult result = init();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("field_sheet.html"), HasSubstr("awmr check")));
  EXPECT_EQ(read_all(path("surge.csv")), "wheel_force,distance_m,elapsed_s\n");
  EXPECT_EQ(read_all(path("turning.csv")), "steering_deg,wheel_force,turns,elapsed_s\n");
  EXPECT_EQ(read_all(path("coastdown.csv")), "initial_speed_mps,stop_time_s\n");
  const nlohmann::json vehicle = json("vehicle.json").flatten();
  for (const auto& [pointer, value] : vehicle.items()) {
    EXPECT_TRUE(value.is_null() || pointer == "/schema" || pointer == "/name") << pointer;
  }
  EXPECT_TRUE(json("scenarios/square.json")["speed_mps"].is_null());
  EXPECT_TRUE(json("scenarios/heading_steps.json")["speed_mps"].is_null());
}

TEST_F(Init, ExplainsEveryKeyThatIsNull) {
  for (const char* drive :
       {" --drive four_wheel", " --drive differential", " --drive front_wheel"}) {
    ASSERT_EQ(init(drive).exit_code, 0);
    const std::string readme = read_all(path("README.md"));
    const nlohmann::json vehicle = json("vehicle.json").flatten();
    for (const auto& [pointer, value] : vehicle.items()) {
      if (!value.is_null()) continue;
      std::string key = pointer.substr(1);
      std::replace(key.begin(), key.end(), '/', '.');
      EXPECT_THAT(readme, HasSubstr("| `" + key + "` |")) << drive;
    }
    for (const auto& entry : fs::recursive_directory_iterator(path(""))) {
      if (entry.is_regular_file()) {
        EXPECT_THAT(read_all(entry.path()), AllOf(Not(HasSubstr("@steer")), Not(HasSubstr("@diff")),
                                                  Not(HasSubstr("@front"))));
      }
    }
    fs::remove_all(path(""));
  }
}

TEST_F(Init, ARobotWithoutSteeringHasNoSteeringKeys) {
  ASSERT_EQ(init(" --drive differential").exit_code, 0);
  EXPECT_EQ(json("vehicle.json")["drive"], "differential");
  EXPECT_EQ(json("vehicle.json").count("steering"), 0U);
  EXPECT_EQ(read_all(path("turning.csv")), "force_left,force_right,turns,elapsed_s\n");
  EXPECT_THAT(read_all(path("README.md")), Not(HasSubstr("steering.max_deg")));
}

TEST_F(Init, AFrontWheelDriveHasSteeringKeys) {
  ASSERT_EQ(init(" --drive front_wheel").exit_code, 0);
  EXPECT_EQ(json("vehicle.json")["drive"], "front_wheel");
  EXPECT_EQ(json("vehicle.json").count("steering"), 1U);
  EXPECT_EQ(read_all(path("turning.csv")), "steering_deg,wheel_force,turns,elapsed_s\n");
}

TEST_F(Init, OverwritesNothingAndThenWritesNothing) {
  fs::create_directories(path("scenarios"));
  write_all(path("surge.csv"), "precious");
  write_all(path("scenarios/mine.json"), "mine");
  const ProcessResult result = init();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("surge.csv: already exists"));
  EXPECT_EQ(read_all(path("surge.csv")), "precious");
  EXPECT_FALSE(fs::exists(path("vehicle.json")));
  fs::remove(path("surge.csv"));
  EXPECT_EQ(init().exit_code, 0) << "files with other names do not prevent init";
  EXPECT_EQ(read_all(path("scenarios/mine.json")), "mine");
}

TEST_F(Init, WhereItCannotWriteItLeavesNothing) {
  write_all(directory_.path() / "rover", "a file");
  EXPECT_EQ(init().exit_code, 2);
  EXPECT_EQ(read_all(directory_.path() / "rover"), "a file");
}

TEST_F(Init, NullValuesAreRefusedByTheStepsThatNeedThem) {
  ASSERT_EQ(init().exit_code, 0);
  const ProcessResult result =
      awmr("run " + path("project.json").string() + " -o " + path("out").string());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("/mass_kg"));
  EXPECT_FALSE(fs::exists(path("out")));
}

}  // namespace
}  // namespace awmr::testing::init_test
