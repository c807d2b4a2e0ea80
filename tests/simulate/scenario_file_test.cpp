#include <gmock/gmock.h>

#include "awmr/core/units.h"
#include "awmr/simulate/scenario.h"
#include "support/process.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

const std::string kHeading = R"({
  "name": "two headings", "duration_s": 4,
  "initial": {"x_m": 1, "y_m": 2, "psi_deg": 90, "u_mps": 0, "v_mps": 0, "r_degps": 10},
  "speed_mps": 1,
  "guidance": {"type": "heading", "steps": [{"t_s": 0, "psi_deg": 30}, {"t_s": 2, "psi_deg": -30}]}
})";

Result<Scenario> read(const std::string& text) {
  const TemporaryDirectory directory;
  write_all(directory.path() / "s.json", text);
  return read_scenario(directory.path() / "s.json");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ScenarioFile, ReadsHeadingStepsInRadians) {
  const auto scenario = read(kHeading);
  ASSERT_TRUE(scenario) << to_text(scenario.error());
  EXPECT_EQ(scenario->initial.psi_rad, radians(90.0));
  EXPECT_EQ(scenario->initial.r_radps, radians(10.0));
  const auto& steps = std::get<HeadingSteps>(scenario->guidance).steps;
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[1].t_s, 2.0);
  EXPECT_EQ(steps[1].psi_rad, radians(-30.0));
}

TEST(ScenarioFile, NamesEveryFaultByPointer) {
  const std::pair<std::string, std::string> cases[] = {
      {replaced(kHeading, "\"duration_s\": 4", "\"duration_s\": 0"), "/duration_s"},
      {replaced(kHeading, "\"speed_mps\": 1", "\"speed_mps\": -1"), "/speed_mps"},
      {replaced(kHeading, "speed_mps", "sped_mps"), "did you mean \"speed_mps\""},
      {replaced(kHeading, "\"t_s\": 2", "\"t_s\": 0"), "/guidance/steps"},
      {replaced(kHeading, "\"t_s\": 0", "\"t_s\": 1"), "first step has to be at t_s = 0"},
      {replaced(kHeading, "\"heading\"", "\"heding\""), "did you mean heading"},
      {replaced(kHeading, "\"x_m\": 1, ", ""), "/initial/x_m"},
  };
  for (const auto& [text, words] : cases) {
    const auto scenario = read(text);
    ASSERT_FALSE(scenario) << words;
    EXPECT_EQ(exit_code(scenario.error()), 2);
    EXPECT_THAT(to_text(scenario.error()), HasSubstr(words));
  }
}

TEST(ScenarioFile, EveryShippedScenarioReads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(AWMR_SOURCE_DIR) +
                                                               "/configs/paper/scenarios")) {
    const auto scenario = read_scenario(entry.path());
    EXPECT_TRUE(scenario) << (scenario ? "" : to_text(scenario.error()));
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(YawModeNames, GoBothWays) {
  for (const YawMode mode : kYawModes) EXPECT_EQ(yaw_mode_by_name(name_of(mode)), mode);
  EXPECT_FALSE(yaw_mode_by_name("sideways"));
}

}  // namespace
}  // namespace awmr::testing
