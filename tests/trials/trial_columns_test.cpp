/// Column mappings of trials: from the vehicle, unknown ones, unused ones.
#include "awmr/trials/trial_columns.h"

#include <gmock/gmock.h>

#include "awmr/trials/load.h"
#include "steady_log.h"
#include "trial_text.h"

namespace awmr::testing::trial_columns_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Loads a surge table `tau,V` with these mappings and returns the error text; empty if accepted.
std::string refusal_of(const std::vector<std::string>& mappings,
                       const std::map<std::string, std::string>& vehicle_columns = {}) {
  const ScratchFile file("surge.csv", "tau,V\n0.5,0.9\n1,2.7\n2,5.4\n");
  TrialFiles files{.surge = file.path()};
  Vehicle vehicle = paper_vehicle();
  vehicle.columns = vehicle_columns;
  for (const std::string& text : mappings) files.options.columns.push_back(*parse_column(text));
  const auto trials = load_trials(vehicle, files);
  return trials ? "" : to_text(trials.error());
}

TEST(TrialColumns, AMappingOfAnUnknownColumnIsRefusedWithTheNearest) {
  EXPECT_THAT(refusal_of({"tau_speed=tau", "speed_mps=V/3.6", "sped_mps=V"}),
              AllOf(HasSubstr("sped_mps=V"), HasSubstr("did you mean speed_mps?")));
}

TEST(TrialColumns, AMappingThatNoFileUsedIsRefused) {
  EXPECT_THAT(refusal_of({"tau_speed=tau", "speed_mps=V/3.6", "distance_m=D"}),
              AllOf(HasSubstr("distance_m=D"), HasSubstr("unused")));
  EXPECT_THAT(refusal_of({"tau_speed=tau", "speed_mps=V/3.6", "heading_deg=V"}),
              HasSubstr("unused"))
      << "heading_deg is no column of a surge table";
  EXPECT_THAT(refusal_of({"tau_speed=tau", "other.csv:speed_mps=V/3.6"}), HasSubstr("no speed"));
}

TEST(TrialColumns, AnUnusableMappingIsNamedWithTheMissingColumn) {
  EXPECT_THAT(refusal_of({"tau_speed=tau", "speed_mps=v"}),
              AllOf(HasSubstr("no speed"), HasSubstr("no file that was read has a column \"v\""),
                    HasSubstr("did you mean \"V\"?")));
  EXPECT_THAT(refusal_of({"tau_speed=tau", "surge:speed_mps=V"}), HasSubstr("is called surge;"));
}

TEST(TrialColumns, TheVehiclesMappingsServeAndMayBeUnused) {
  EXPECT_EQ(refusal_of({}, {{"tau_speed", "tau"}, {"speed_mps", "V/3.6"}, {"heading_deg", "psi"}}),
            "");
  EXPECT_THAT(refusal_of({}, {{"tau_speed", "tau"}, {"speed_mps", "V/3.6"}, {"headin_deg", "psi"}}),
              HasSubstr("did you mean heading_deg?"));
}

TEST(TrialColumns, TheValuesAreThoseOfTheExpression) {
  const ScratchFile file("surge.csv", "tau,V\n0.5,0.9\n1,2.7\n2,5.4\n");
  const TrialOptions options{
      .columns = {*parse_column("tau_speed=tau*1"), *parse_column("speed_mps=(V + V)/2/3.6")}};
  std::vector<Finding> findings;
  const auto surge = read_surge(file.path(), options, findings);
  ASSERT_TRUE(surge) << to_text(surge.error());
  EXPECT_DOUBLE_EQ(surge->rows[1].speed_mps, 0.75);
}

TEST(TrialColumns, ALogTakesCommandsAndChannelsByExpression) {
  std::string text = steady_log_text();
  text.replace(0, text.find('\n'), "t_s,duty_l,duty_r,delta,v,w");
  const ScratchFile file("log.csv", text);
  TrialFiles files{.logs = {file.path()}};
  for (const char* mapping : {"force_left=duty_l*12/12", "force_right=duty_r", "steering_deg=delta",
                              "speed_mps=v*1", "yaw_rate_radps=-(0 - w)"}) {
    files.options.columns.push_back(*parse_column(mapping));
  }
  const auto mapped = load_trials(paper_vehicle(), files);
  ASSERT_TRUE(mapped) << to_text(mapped.error());
  const ScratchFile plain("log.csv", steady_log_text());
  const auto expected = load_trials(paper_vehicle(), {.logs = {plain.path()}});
  ASSERT_TRUE(expected);
  EXPECT_EQ(mapped->data.logs[0].force_left, expected->data.logs[0].force_left);
  EXPECT_EQ(mapped->data.logs[0][LogChannel::kYawRate]->value,
            expected->data.logs[0][LogChannel::kYawRate]->value);
}

}  // namespace
}  // namespace awmr::testing::trial_columns_test
