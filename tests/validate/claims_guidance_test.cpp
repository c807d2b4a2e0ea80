/// The paper's claims C8 to C12 on guidance, and the files of the runs that evaluate them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "awmr/model/gains_file.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/validate/claims.h"
#include "awmr/validate/paper_scenarios.h"
#include "validate/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

std::vector<Claim> guidance_claims_of(const Model& model) {
  const Plant<double> plant = *model.plant();
  const ClaimSetting setting{model, plant, kPaperGains, batch_arithmetic().value()};
  return check_guidance_claims({&setting, 1}).front();
}

const Claim& claim_of(const std::string& id) {
  static const std::vector<Claim> claims = guidance_claims_of(fitted_paper_model());
  return *std::find_if(claims.begin(), claims.end(),
                       [&](const Claim& claim) { return claim.id == id; });
}

TEST(GuidanceClaims, WaypointsLineAndObstaclesAreReproduced) {
  for (const char* id : {"C8", "C9", "C10"}) {
    EXPECT_TRUE(claim_of(id).reproduced) << id << ": " << claim_of(id).figure;
  }
}

TEST(GuidanceClaims, TheTimedPathIsTooTightForSteering) {
  // Steering turns at 1 m/s with 0.2 rad/s, radius 5 m; the path's corners are tighter than 1 m.
  EXPECT_FALSE(claim_of("C11").reproduced);
  EXPECT_THAT(claim_of("C11").why, HasSubstr("too tight for steering"));
}

TEST(GuidanceClaims, CombinedIsNotTheOnlyBestMode) {
  EXPECT_FALSE(claim_of("C12").reproduced);
  EXPECT_THAT(claim_of("C12").why,
              HasSubstr("differential mode is within 1 % of the smallest RMS cross-track error"));
}

TEST(GuidanceClaims, AVehicleThatCannotTurnFails) {
  Model model = fitted_paper_model();
  model.vehicle.steering_max_deg = 3.0;
  const std::vector<Claim> claims = guidance_claims_of(model);
  EXPECT_FALSE(claims.front().reproduced);
  EXPECT_THAT(claims.front().why, HasSubstr("too wide for the acceptance radius in steering"));
}

std::string run_of(const Scenario& scenario) {
  const Model model = fitted_paper_model();
  const Plant<double> plant = *model.plant();
  Scenario first = scenario;
  first.duration_s = std::min(first.duration_s, 30.0);
  const awmr::Run run = simulate(plant, make_controller(plant, model.vehicle, kPaperGains), first,
                                 YawMode::kCombined, {});
  return run_csv(run, first);
}

TEST(GuidanceClaims, TheFilesOfThePapersScenariosAreTheSameRuns) {
  const std::pair<const char*, Scenario> pairs[] = {
      {"c8_waypoints", waypoint_scenario()},
      {"c9_line", line_scenario()},
      {"c10_obstacle_on_line", obstacle_on_line_scenario()},
      {"c10_obstacle_between_waypoints", obstacle_between_waypoints_scenario()},
      {"c11_lissajous", lissajous_scenario(false)},
      {"c11_lissajous_closed", lissajous_scenario(true)},
      {"c12_waypoints_and_line", polyline_scenario()}};
  for (const auto& [name, scenario] : pairs) {
    const std::string path =
        std::string(AWMR_SOURCE_DIR) + "/configs/paper/scenarios/" + name + ".json";
    const auto read = read_scenario(path);
    ASSERT_TRUE(read) << to_text(read.error());
    EXPECT_EQ(read->name, scenario.name);
    EXPECT_EQ(read->duration_s, scenario.duration_s);
    EXPECT_EQ(run_of(*read), run_of(scenario)) << name;
  }
}

}  // namespace
}  // namespace awmr::testing
