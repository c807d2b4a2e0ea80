/// What turns by the sides' forces meet beside the resistance of steered turns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/core/units.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/model_file.h"
#include "identify/synthetic.h"
#include "support/paper_vehicle.h"
#include "support/scratch_file.h"

namespace awmr::testing {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr Truth kTruth = kTruths[0];

Vehicle steered() {
  Vehicle v = paper_vehicle();
  v.sway_alpha = 3.0;
  return v;
}

/// A turn at this rate that meets `scrub_m` beside g3; the noise is a factor on its moment.
TurningRow by_sides(double rate_radps, double scrub_m, double factor, int line) {
  const double moment_m = factor * (kTruth.a3 * std::pow(rate_radps, kTruth.b3) + scrub_m);
  const double half = moment_m / (4.0 * steered().half_track_m);
  return {.line = line,
          .tau_turn_m = moment_m,
          .yaw_rate_radps = rate_radps,
          .turns = {},
          .elapsed_s = {},
          .sides = SideForces<double>{0.2 - half, 0.2 + half}};
}

/// The steered turns of synthetic(), and four by the sides at their rates.
TrialData turns(double scrub_m, double sigma, std::uint64_t seed) {
  TrialData data = synthetic(kTruth, sigma, seed);
  Random random(seed, 1);
  for (int i = 1; i <= 4; ++i) {
    data.turning->by_sides.push_back(
        by_sides(0.07 * i, scrub_m, std::exp(sigma * random.normal()), 20 + i));
  }
  return data;
}

std::vector<std::string> codes(const Model& model) {
  std::vector<std::string> all;
  for (const Finding& finding : model.record.findings) all.push_back(finding.code);
  return all;
}

Model identified(const TrialData& data) {
  const auto result = identify(steered(), data, {.side_by_side = false}, {});
  EXPECT_TRUE(result) << to_text(result.error());
  return result->model;
}

TEST(Scrub, IsWhatTurnsByTheSidesMeetBesideYawResistance) {
  const Model model = identified(turns(0.012, 1e-6, 1));
  ASSERT_TRUE(model.yaw_scrub);
  EXPECT_NEAR(model.yaw_scrub->moment_m, 0.012, 1e-6);
  EXPECT_EQ(model.yaw_scrub->rows, 4);
  EXPECT_DOUBLE_EQ(model.yaw_scrub->yaw_rate_radps.lo, 0.07);
  EXPECT_DOUBLE_EQ(model.yaw_scrub->yaw_rate_radps.hi, 0.28);
  // Yaw resistance is that of the steered turns, scrub or none.
  EXPECT_EQ(model[ParameterId::kYawAlpha].value,
            identified(synthetic(kTruth, 1e-6, 1))[ParameterId::kYawAlpha].value);
  EXPECT_THAT(codes(model), Not(Contains("scrub-grows")));
  EXPECT_THAT(codes(model), Not(Contains("scrub-beyond-trials")));
}

TEST(Scrub, IntervalsHoldAtTheirRateAtLeast) {
  constexpr int kTables = 500;
  int held = 0;
  for (int seed = 1; seed <= kTables; ++seed) {
    const Model model = identified(turns(0.01, 0.03, static_cast<std::uint64_t>(seed)));
    ASSERT_TRUE(model.yaw_scrub);
    held += model.yaw_scrub->ci95_m.contains(0.01) ? 1 : 0;
  }
  RecordProperty("held", held);
  // With few turns Welch's degrees of freedom are on the safe side: 97 % of 2,000 tables. Either side
  // of it four standard errors of a binomial share.
  const double share = held / double(kTables);
  EXPECT_GT(share, 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / kTables));
  EXPECT_LT(share, 0.97 + 4.0 * std::sqrt(0.97 * 0.03 / kTables));
}

TEST(Scrub, NeedsThreeTurns) {
  TrialData data = turns(0.01, 0.03, 1);
  data.turning->by_sides.resize(2);
  const Model model = identified(data);
  EXPECT_FALSE(model.yaw_scrub);
  EXPECT_THAT(codes(model), Contains("few-scrub-rows"));
}

TEST(Scrub, LessThanNothingIsRefused) {
  TrialData data = turns(0.0, 0.01, 1);
  for (TurningRow& row : data.turning->by_sides) row.yaw_rate_radps *= 57.29578;  // left in deg/s
  const Model model = identified(data);
  EXPECT_FALSE(model.yaw_scrub);
  EXPECT_THAT(codes(model), Contains("negative-scrub"));
}

TEST(Scrub, SaysWhereItIsNoConstant) {
  TrialData data = synthetic(kTruth, 0.01, 1);
  Random random(5, 1);
  for (int i = 1; i <= 6; ++i) {
    const double rate_radps = 0.05 * i;
    data.turning->by_sides.push_back(
        by_sides(rate_radps, 0.2 * rate_radps, std::exp(0.01 * random.normal()), 20 + i));
  }
  EXPECT_THAT(codes(identified(data)), Contains("scrub-grows"));
}

TEST(Scrub, SaysWhereYawResistanceIsExtrapolated) {
  TrialData data = turns(0.01, 0.01, 1);
  data.turning->by_sides.push_back(by_sides(0.6, 0.01, 1.0, 30));
  EXPECT_THAT(codes(identified(data)), Contains("scrub-beyond-trials"));
}

TEST(Scrub, IsReadBackFromModelJson) {
  const Model model = identified(turns(0.012, 0.02, 1));
  const ScratchFile file("model.json", model_text(model));
  const auto read = read_model(file.path());
  ASSERT_TRUE(read) << to_text(read.error());
  ASSERT_TRUE(read->yaw_scrub);
  EXPECT_EQ(read->yaw_scrub->moment_m, model.yaw_scrub->moment_m);
  EXPECT_EQ(read->yaw_scrub->std_error_m, model.yaw_scrub->std_error_m);
  EXPECT_EQ(read->yaw_scrub->ci95_m.lo, model.yaw_scrub->ci95_m.lo);
  EXPECT_EQ(read->yaw_scrub->ci95_m.hi, model.yaw_scrub->ci95_m.hi);
  EXPECT_EQ(read->yaw_scrub->rows, 4);
}

TEST(Scrub, AModelThatContradictsItselfIsRefused) {
  Model model = identified(turns(0.012, 0.02, 1));
  model.yaw_scrub->moment_m = 1.0;
  const ScratchFile file("model.json", model_text(model));
  EXPECT_FALSE(read_model(file.path()));
}

TEST(Scrub, IsSuggestedWithForcesThatMakeTheRatesOfTheSteeredTurns) {
  const Model model = identified(synthetic(kTruth, 0.03, 1));
  const auto suggestion = suggest(model, {});
  ASSERT_TRUE(suggestion) << to_text(suggestion.error());
  ASSERT_THAT(suggestion->scrub_turns, SizeIs(3));
  for (const ScrubTurn& turn : suggestion->scrub_turns) {
    const double made_m = 2.0 * model.vehicle.half_track_m * (turn.force.right - turn.force.left);
    const double resisted_m =
        *model[ParameterId::kYawAlpha].value *
        std::pow(radians(turn.yaw_rate_degps), *model[ParameterId::kYawBeta].value);
    EXPECT_NEAR(made_m, resisted_m, 1e-12);
    EXPECT_TRUE(model.vehicle.wheel_force.contains(turn.force.left));
    EXPECT_TRUE(model.vehicle.wheel_force.contains(turn.force.right));
  }
  EXPECT_THAT(field_sheet(*suggestion, 3), ::testing::HasSubstr("choice between differential"));
  EXPECT_THAT(suggest(identified(turns(0.01, 0.03, 1)), {})->scrub_turns, IsEmpty());
}

}  // namespace
}  // namespace awmr::testing
