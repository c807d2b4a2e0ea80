/// Scrub moment of differential turns, in addition to the resistance of steered turns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/units.h"
#include "awmr/identify/planning/candidates.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/model_file.h"
#include "identify/synthetic.h"
#include "support/paper_vehicle.h"
#include "support/scratch_file.h"

namespace awmr::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr Truth kTruth = kTruths[0];

Vehicle steered() {
  Vehicle v = paper_vehicle();
  v.sway_alpha = 3.0;
  return v;
}

/// Row of a differential turn at this yaw rate: its moment is g3 plus the scrub moment `scrub_m`,
/// all times `factor` (the noise).
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

/// The steered turns of synthetic(), and four differential turns at their rates.
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

TEST(Scrub, EqualsTheExcessMomentOfDifferentialTurns) {
  const Model model = identified(turns(0.012, 1e-6, 1));
  ASSERT_TRUE(model.yaw_scrub);
  EXPECT_NEAR(model.yaw_scrub->moment_m, 0.012, 1e-6);
  EXPECT_EQ(model.yaw_scrub->rows, 4);
  EXPECT_DOUBLE_EQ(model.yaw_scrub->yaw_rate_radps.lo, 0.07);
  EXPECT_DOUBLE_EQ(model.yaw_scrub->yaw_rate_radps.hi, 0.28);
  // The identified yaw resistance is that of the steered turns, with or without scrub.
  EXPECT_EQ(model[ParameterId::kYawAlpha].value,
            identified(synthetic(kTruth, 1e-6, 1))[ParameterId::kYawAlpha].value);
  EXPECT_THAT(codes(model), Not(Contains("scrub-grows")));
  EXPECT_THAT(codes(model), Not(Contains("scrub-beyond-trials")));
}

TEST(Scrub, IntervalsCoverTheTruthAtLeastAtTheirRate) {
  constexpr int kTables = 500;
  int held = 0;
  for (int seed = 1; seed <= kTables; ++seed) {
    const Model model = identified(turns(0.01, 0.03, static_cast<std::uint64_t>(seed)));
    ASSERT_TRUE(model.yaw_scrub);
    held += model.yaw_scrub->ci95_m.contains(0.01) ? 1 : 0;
  }
  RecordProperty("held", held);
  // With few turns Welch's degrees of freedom make the intervals slightly too wide: they contained
  // the truth in 97 % of 2,000 tables. The bounds are four binomial standard errors below 95 % and
  // above 97 %.
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

TEST(Scrub, RefusesANegativeScrub) {
  TrialData data = turns(0.0, 0.01, 1);
  for (TurningRow& row : data.turning->by_sides) row.yaw_rate_radps *= 57.29578;  // in deg/s
  const Model model = identified(data);
  EXPECT_FALSE(model.yaw_scrub);
  EXPECT_THAT(codes(model), Contains("negative-scrub"));
}

TEST(Scrub, NamesTheMomentsOfTheSlowestAndTheFastestTurn) {
  TrialData data = synthetic(kTruth, 1e-6, 1);
  for (const int i : {3, 6, 1, 4, 2, 5}) {
    const double rate_radps = 0.05 * i;
    data.turning->by_sides.push_back(by_sides(rate_radps, 0.07 - 0.2 * rate_radps, 1.0, 20 + i));
  }
  const Model model = identified(data);
  const auto& findings = model.record.findings;
  const auto grows = std::ranges::find(findings, "scrub-grows", &Finding::code);
  ASSERT_NE(grows, findings.end());
  EXPECT_THAT(grows->message,
              HasSubstr("0.06 to 0.01 m in the differential turns at 2.86 to 17.2"));
}

TEST(Scrub, ReportsTheRangeOfAScrubThatChangesWithTheRate) {
  // The true scrub moment is 0.2 r, m, at yaw rates r from 0.05 to 0.3 rad/s.
  constexpr int kTables = 200;
  int findings = 0, held = 0;
  for (std::uint64_t seed = 1; seed <= kTables; ++seed) {
    TrialData data = synthetic(kTruth, 0.01, seed);
    Random random(seed, 5);
    for (int i = 1; i <= 6; ++i) {
      const double rate_radps = 0.05 * i;
      data.turning->by_sides.push_back(
          by_sides(rate_radps, 0.2 * rate_radps, std::exp(0.01 * random.normal()), 20 + i));
    }
    const Model model = identified(data);
    ASSERT_TRUE(model.yaw_scrub);
    const auto& changing = model.yaw_scrub->changing_m;
    if (!changing) continue;
    EXPECT_THAT(codes(model), Contains("scrub-grows"));
    ++findings;
    held += changing->lo < 0.2 * 0.05 && changing->hi > 0.2 * 0.30 ? 1 : 0;
  }
  RecordProperty("held", held);
  EXPECT_EQ(findings, kTables);
  // Both ends of the reported range must be right. Each end is right with a probability of 97.5 %,
  // so both are right in at least 95 % of the tables.
  EXPECT_GT(held / double(kTables), 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / kTables));
}

/// Makes 200 tables with constant scrub and returns the number for which a rate-dependent scrub is
/// (wrongly) reported. `turn` makes a row from its number and a standard normal deviate.
template <class MakeTurn>
int alarms_with(const MakeTurn& turn) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    TrialData data = synthetic(kTruth, 0.02, seed);
    Random random(seed, 7);
    for (int i = 1; i <= 8; ++i) data.turning->by_sides.push_back(turn(i, random.normal()));
    const Model model = identified(data);
    alarms += model.yaw_scrub && model.yaw_scrub->changing_m ? 1 : 0;
  }
  return alarms;
}

TEST(Scrub, IsConstantForTurnsWithOneForceOrAtOneRate) {
  // All turns have the same force and scattered yaw rates. The computed scrub of a turn, force
  // minus resistance, then falls with its rate although the true scrub is constant.
  const TurningRow exact = by_sides(0.2, 0.01, 1.0, 20);
  EXPECT_LE(alarms_with([&](int i, double deviate) {
              TurningRow row = exact;
              row.yaw_rate_radps *= std::exp(0.1 * deviate);
              row.line += i;
              return row;
            }),
            0);
  // All turns have the same yaw rate, with scattered moments.
  EXPECT_LE(alarms_with([](int i, double deviate) {
              return by_sides(0.2, 0.01, std::exp(0.1 * deviate), 20 + i);
            }),
            0);
  // Turns at several rates: a false finding is expected in at most 10 of 200 tables (5 %). 12 more
  // are allowed, four standard errors.
  EXPECT_LE(alarms_with([](int i, double deviate) {
              return by_sides(0.05 * (1 + i % 4), 0.01, std::exp(0.03 * deviate), 20 + i);
            }),
            10 + 12);
}

/// A turn attempt under this moment in which the vehicle did not turn.
TurningRow standing(double moment_m, int line) {
  TurningRow row = by_sides(0.1, 0.0, 1.0, line);
  const double half = moment_m / (4.0 * steered().half_track_m);
  row.tau_turn_m = moment_m;
  row.yaw_rate_radps = 0.0;
  row.sides = SideForces<double>{0.2 - half, 0.2 + half};
  return row;
}

TEST(Scrub, IsAtLeastTheLargestMomentWithoutATurn) {
  TrialData data = synthetic(kTruth, 0.02, 1);
  data.turning->standing = {standing(0.05, 21), standing(0.09, 22), standing(0.07, 23)};
  const Model model = identified(data);
  EXPECT_FALSE(model.yaw_scrub);
  ASSERT_TRUE(model.yaw_held_m);
  EXPECT_DOUBLE_EQ(*model.yaw_held_m, 0.09);
  EXPECT_THAT(codes(model), Contains("scrub-holds"));
  EXPECT_THAT(codes(model), Contains("few-scrub-rows"));
  // The suggested turns use moments from the static scrub moment up to that of sliding tyres.
  const ScrubPlan plan = scrub_plan(model);
  ASSERT_FALSE(plan.turns.empty());
  for (const ScrubTurn& turn : plan.turns) {
    EXPECT_GT(2.0 * steered().half_track_m * (turn.least.right - turn.least.left), 0.09);
    EXPECT_GE(turn.most.right - turn.most.left, turn.least.right - turn.least.left);
  }
  const ScratchFile file("model.json", model_text(model));
  EXPECT_EQ(read_model(file.path())->yaw_held_m, model.yaw_held_m);
}

TEST(Scrub, KeepsTheScrubOfTurnsApartFromTheMomentWithoutATurn) {
  TrialData data = turns(0.01, 0.02, 1);
  data.turning->standing = {standing(0.05, 31)};
  const Model model = identified(data);
  ASSERT_TRUE(model.yaw_scrub);
  EXPECT_LT(model.yaw_scrub->ci95_m.hi, 0.05);
  EXPECT_DOUBLE_EQ(model.yaw_held_m.value_or(0.0), 0.05);
}

TEST(Scrub, WarnsIfYawResistanceIsExtrapolated) {
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

TEST(Scrub, RefusesAContradictoryModel) {
  const Model model = identified(turns(0.012, 0.02, 1));
  const auto is_refused = [&](const char* place, const auto& change) {
    Model changed = model;
    change(*changed.yaw_scrub);
    const ScratchFile file("model.json", model_text(changed));
    const auto read = read_model(file.path());
    EXPECT_FALSE(read) << place;
    if (!read) {
      EXPECT_THAT(to_text(read.error()), ::testing::HasSubstr(place));
    }
  };
  is_refused("/yaw_scrub/ci95_m", [](YawScrub& scrub) { scrub.moment_m = 1.0; });
  is_refused("/yaw_scrub/ci95_m", [](YawScrub& scrub) {
    scrub.moment_m -= 1.0;
    scrub.ci95_m = {scrub.ci95_m.lo - 1.0, scrub.ci95_m.hi - 1.0};
  });
  is_refused("/yaw_scrub/moment_m", [](YawScrub& scrub) {  // more than the motors can apply
    scrub.moment_m += 10.0;
    scrub.ci95_m = {scrub.ci95_m.lo + 10.0, scrub.ci95_m.hi + 10.0};
  });
  is_refused("/yaw_scrub/moment_m", [](YawScrub& scrub) {
    scrub.moment_m = 0.9 * scrub.ci95_m.hi + 0.1 * scrub.ci95_m.lo;
  });
  is_refused("/yaw_scrub/std_error_m", [](YawScrub& scrub) { scrub.std_error_m *= 20.0; });
  is_refused("/yaw_scrub/std_error_m", [](YawScrub& scrub) { scrub.std_error_m /= 20.0; });
  is_refused("/yaw_scrub/yaw_rate_radps", [](YawScrub& scrub) { scrub.yaw_rate_radps.lo = 0.0; });
}

double moment_of(const SideForces<double>& force) {
  return 2.0 * steered().half_track_m * (force.right - force.left);
}

/// Returns g3(r), m, of the model's power law.
double resisted_m(const Model& model, double rate_degps) {
  return *model[ParameterId::kYawAlpha].value *
         std::pow(radians(rate_degps), *model[ParameterId::kYawBeta].value);
}

TEST(Scrub, IsSuggestedFromNoScrubToTyresThatSlide) {
  const Model model = identified(synthetic(kTruth, 0.03, 1));
  const auto suggestion = suggest(model, {});
  ASSERT_TRUE(suggestion) << to_text(suggestion.error());
  ASSERT_THAT(suggestion->scrub_turns, SizeIs(3));
  for (const ScrubTurn& turn : suggestion->scrub_turns) {
    EXPECT_NEAR(moment_of(turn.least), resisted_m(model, turn.yaw_rate_degps), 1e-12);
    EXPECT_GT(moment_of(turn.most), moment_of(turn.least));
    for (const double force :
         {turn.least.left, turn.least.right, turn.most.left, turn.most.right}) {
      EXPECT_TRUE(model.vehicle.wheel_force.contains(force));
    }
  }
  EXPECT_THAT(field_sheet(*suggestion, 3), ::testing::HasSubstr("choice between differential"));
}

TEST(Scrub, SuggestsTheNextDifferentialTurns) {
  const Model model = identified(turns(0.01, 0.03, 1));
  const ScrubPlan plan = scrub_plan(model);
  ASSERT_THAT(plan.turns, SizeIs(3));
  for (const ScrubTurn& turn : plan.turns) {
    const double scrub_m = moment_of(turn.least) - resisted_m(model, turn.yaw_rate_degps);
    EXPECT_NEAR(scrub_m, std::max(0.0, model.yaw_scrub->ci95_m.lo), 1e-12);
  }
  EXPECT_THAT(plan.about, ::testing::HasSubstr("measured in 4 turns"));
}

TEST(Scrub, IsPartOfYawResistanceWithoutSteeredTurns) {
  TrialData data = synthetic(kTruth, 0.02, 1);
  for (TurningRow& row : data.turning->rows) {
    row = by_sides(row.yaw_rate_radps, 0.02, 1.0, row.line);
  }
  const Model model = identified(data);
  EXPECT_TRUE(model.yaw_by_sides_alone);
  EXPECT_FALSE(model.yaw_scrub);
  const auto suggestion = suggest(model, {});
  ASSERT_TRUE(suggestion) << to_text(suggestion.error());
  EXPECT_THAT(suggestion->scrub_turns, IsEmpty());
  EXPECT_THAT(suggestion->about_scrub, ::testing::HasSubstr("three steered turns"));
  const ScratchFile file("model.json", model_text(model));
  EXPECT_TRUE(read_model(file.path())->yaw_by_sides_alone);
}

}  // namespace
}  // namespace awmr::testing
