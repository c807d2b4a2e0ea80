/// From a log with unusual column names to a model: `awmr map`, its file as input, and the result
/// of identify.
#include <gmock/gmock.h>

#include <sstream>

#include "cli/program.h"

namespace awmr::testing::map_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Map : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  /// Writes the synthetic drive with other column names, times in ms, speeds in km/h, semicolons
  /// between cells and decimal commas.
  void write_foreign_log() {
    std::istringstream lines(
        read_all(std::string(AWMR_SOURCE_DIR) + "/datasets/synthetic/drive_1.csv"));
    std::string text =
        "time_ms;duty_left;duty_right;steering_setpoint_deg;pos_x_m;pos_y_m;heading;v (km/h);"
        "gyro_z_radps;battery_v\n";
    for (std::string line; std::getline(lines, line);) {
      if (line.empty() || line[0] == '#' || line[0] == 't') continue;
      std::istringstream cells(line);
      std::string cell;
      for (int column = 0; std::getline(cells, cell, ','); ++column) {
        const double factor = column == 0 ? 1000.0 : column == 7 ? 3.6 : 1.0;
        std::ostringstream number;
        number.precision(15);
        number << std::stod(cell) * factor;
        std::string shown = number.str();
        for (char& c : shown) c = c == '.' ? ',' : c;
        text += (column == 0 ? "" : ";") + shown;
      }
      text += ";12\n";
    }
    write_all(path("foreign.csv"), text);
  }
  TemporaryDirectory directory_;
};

TEST_F(Map, WritesGuessesThatIdentifyTakesBack) {
  write_foreign_log();
  const ProcessResult mapped = awmr("map " + path("foreign.csv") + " -o " + path("map.json"));
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  EXPECT_THAT(mapped.out, HasSubstr("likely speed_mps         `v (km/h)`*0.2777778"));
  EXPECT_THAT(mapped.out, Not(HasSubstr("open")));
  EXPECT_THAT(mapped.out, HasSubstr("  unused battery_v\n"));
  const std::string identify = "identify --vehicle configs/paper/vehicle.json --log ";
  const ProcessResult foreign = awmr(identify + path("foreign.csv") + " --columns-file " +
                                     path("map.json") + " --verbose -o " + path("foreign.json"));
  EXPECT_EQ(foreign.exit_code, 0) << foreign.err;
  EXPECT_THAT(foreign.err, HasSubstr("decimal commas"));
  EXPECT_THAT(read_all(path("foreign.json")), HasSubstr("speed_mps=`v (km/h)`*0.2777778"));
}

TEST_F(Map, AMappingThatIsUnknownOrUnusedIsRefused) {
  write_foreign_log();
  const std::string identify = "identify --vehicle configs/paper/vehicle.json --log " +
                               path("foreign.csv") + " -o " + path("model.json") + " --column ";
  EXPECT_THAT(awmr(identify + "sped_mps=v").err, HasSubstr("did you mean speed_mps?"));
  const ProcessResult wrong = awmr(identify + "'force_left=duty_lef*2'");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean \"duty_left\"?"));
}

TEST_F(Map, AMalformedColumnsFileIsRefusedByPointer) {
  write_all(path("map.json"), R"({"columns": {"speed_mps": "v*"}, "colums": {}})");
  const ProcessResult result = awmr(
      "identify --vehicle configs/paper/vehicle.json --log datasets/synthetic/drive_1.csv -o " +
      path("model.json") + " --columns-file " + path("map.json"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("map.json:/columns/speed_mps:"));
  EXPECT_THAT(result.err, HasSubstr("did you mean \"columns\"?"));
}

}  // namespace
}  // namespace awmr::testing::map_test
