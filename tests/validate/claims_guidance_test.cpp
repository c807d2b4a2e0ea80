/// The paper's claims C8 to C12 on guidance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "awmr/validate/claims.h"
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

}  // namespace
}  // namespace awmr::testing
