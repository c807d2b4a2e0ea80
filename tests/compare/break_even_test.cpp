/// Break-even scrub moment, with which a mode loses its advantage over another one: checked by
/// simulate() with a slightly smaller and a slightly larger moment.
#include "awmr/compare/break_even.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/compare/scoring.h"
#include "awmr/core/json/json.h"
#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/simulate.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Scenario turn(double heading_deg) {
  Scenario scenario = short_heading("turn");
  scenario.duration_s = 8.0;
  scenario.guidance = HeadingSteps{{{0.0, radians(heading_deg)}}};
  return scenario;
}

Result<Comparison> compared(const Scenario& scenario, CompareOptions options = {}) {
  options.break_even = true;
  return compare(uncertain_model(), kPaperGains, {scenario}, options);
}

/// True if, with the scrub moment `moment_m` in the runs of both modes by simulate(), the entry's
/// mode settles and its score is no worse than that of the other mode.
bool leads(const Scenario& scenario, const Comparison& comparison, const BreakEven& entry,
           double moment_m) {
  const Model model = uncertain_model();
  const auto controller = controller_for(model, kPaperGains).value();
  SimulateOptions options;
  options.sample_time_s = model.vehicle.sample_time_s;
  const auto metrics_with = [&](YawMode mode, double scrub_m) {
    Plant<double> plant = model.plant().value();
    plant.yaw_scrub_m = scrub_m;
    return metrics_of(simulate(plant, controller, scenario, mode, options), scenario, controller);
  };
  const Metrics own = metrics_with(entry.mode, moment_m);
  const auto scoring = scoring_of(group(comparison).front(), {});
  return own.settling_time_s &&
         log_score(own, scoring) <= log_score(metrics_with(entry.against, moment_m), scoring);
}

TEST(BreakEven, IsWhereTheLeadEnds) {
  const Scenario scenario = turn(60.0);
  const auto comparison = compared(scenario);
  ASSERT_TRUE(comparison) << to_text(comparison.error());
  ASSERT_TRUE(comparison->break_even);
  ASSERT_FALSE(comparison->break_even->empty());
  bool some_ends = false;
  for (const BreakEven& entry : *comparison->break_even) {
    EXPECT_EQ(entry.scenario, "turn");
    EXPECT_NE(entry.mode, YawMode::kSteering);
    EXPECT_TRUE(leads(scenario, *comparison, entry, 0.0));
    EXPECT_DOUBLE_EQ(entry.most_m, 2.0 * 0.36 * 2.0);
    if (!entry.yaw_coulomb_m) continue;
    some_ends = true;
    EXPECT_TRUE(leads(scenario, *comparison, entry, 0.98 * *entry.yaw_coulomb_m));
    EXPECT_FALSE(leads(scenario, *comparison, entry, 1.02 * *entry.yaw_coulomb_m));
  }
  EXPECT_TRUE(some_ends);
}

TEST(BreakEven, DoesNotDependOnThreadsAndIsWrittenOnRequest) {
  const Provenance provenance{"compare", {}, {{"model.json", "abc"}}};
  const CompareOptions one{.samples = 2, .seed = 3, .threads = 1};
  const auto first = compared(turn(60.0), one);
  CompareOptions many = one;
  many.threads = 3;
  const auto second = compared(turn(60.0), many);
  ASSERT_TRUE(first && second);
  const std::string text = comparison_text(*first, one, provenance);
  EXPECT_EQ(text, comparison_text(*second, one, provenance));
  EXPECT_THAT(text, HasSubstr("\"break_even\""));
  EXPECT_THAT(comparison_table(*first),
              HasSubstr("differential ahead of steering in 1 scenario: "));
  Comparison without = *first;
  without.break_even.reset();
  EXPECT_THAT(comparison_text(without, one, provenance), Not(HasSubstr("break_even")));
  EXPECT_THAT(comparison_table(without), Not(HasSubstr("break-even")));
}

TEST(BreakEven, IsEmptyInOpenLoop) {
  const auto comparison = compared(short_open_loop());
  ASSERT_TRUE(comparison);
  EXPECT_TRUE(comparison->break_even->empty());
  EXPECT_THAT(comparison_table(*comparison),
              HasSubstr("neither differential nor combined is ahead"));
}

TEST(BreakEven, IsRefusedForPartsAndSeveralSetsOfGains) {
  const auto part = compared(turn(60.0), {.samples = 3, .shard = {1, 2}});
  ASSERT_FALSE(part);
  EXPECT_THAT(to_text(part.error()), HasSubstr("cannot be combined with"));
  CompareOptions options;
  options.break_even = true;
  const auto sets =
      compare(uncertain_model(), {{"a", kPaperGains}, {"b", kPaperGains}}, {turn(60.0)}, options);
  ASSERT_FALSE(sets);
  EXPECT_EQ(exit_code(sets.error()), 2);
}

/// Comparison for a model with this measured scrub moment of differential turns; empty: not
/// measured.
Comparison table_with(const std::optional<YawScrub>& scrub, std::optional<double> held_m = {}) {
  Model model = uncertain_model();
  model.yaw_scrub = scrub;
  model.yaw_held_m = held_m;
  auto comparison = compare(model, kPaperGains, {turn(60.0)}, {.break_even = true});
  EXPECT_TRUE(comparison);
  return std::move(*comparison);
}

/// A scrub moment with this interval, as measured in ten turns at the rates of the compared runs.
YawScrub scrub_of(const Interval& scrub_m) {
  return {0.5 * (scrub_m.lo + scrub_m.hi),
          0.25 * (scrub_m.hi - scrub_m.lo),
          scrub_m,
          10,
          {radians(20.0), radians(200.0)}};
}

/// Break-even scrub moments in m, computed with a model without a measured scrub.
std::vector<double> ending_moments_m() {
  std::vector<double> moments_m;
  const Comparison comparison = table_with(std::nullopt);
  for (const BreakEven& entry : *comparison.break_even) {
    if (entry.yaw_coulomb_m) moments_m.push_back(*entry.yaw_coulomb_m);
  }
  std::sort(moments_m.begin(), moments_m.end());
  return moments_m;
}

TEST(BreakEven, IsDecidedByTheScrubThatWasMeasured) {
  const std::vector<double> ends_m = ending_moments_m();
  ASSERT_FALSE(ends_m.empty());
  const double least_m = ends_m.front(), most_m = ends_m.back();
  const auto reported = [](const Interval& scrub_m) {
    return comparison_table(table_with(scrub_of(scrub_m)));
  };
  EXPECT_THAT(reported({0.5 * least_m, 0.9 * least_m}),
              HasSubstr("still ahead in 1, no longer in 0, undecided in 0"));
  EXPECT_THAT(reported({1.1 * most_m, 2.0 * most_m}),
              HasSubstr("still ahead in 0, no longer in 1, undecided in 0"));
  EXPECT_THAT(reported({0.5 * least_m, 2.0 * most_m}),
              HasSubstr("still ahead in 0, no longer in 0, undecided in 1"));
}

TEST(BreakEven, IsOpenWhereScrubWasMeasuredAtOtherRates) {
  const std::vector<double> ends_m = ending_moments_m();
  ASSERT_FALSE(ends_m.empty());
  YawScrub scrub = scrub_of({0.5 * ends_m.front(), 0.9 * ends_m.front()});
  scrub.yaw_rate_radps = {radians(1.0), radians(2.0)};
  const Comparison comparison = table_with(scrub);
  for (const BreakEven& entry : *comparison.break_even) {
    if (entry.yaw_coulomb_m) {
      EXPECT_EQ(lead_of(entry), Lead::kOpen);
    }
  }
  EXPECT_THAT(comparison_table(comparison), HasSubstr("scrub was measured at 1 to 2"));
}

TEST(BreakEven, IsDecidedWithAllOfAScrubThatChangesWithTheRate) {
  const std::vector<double> ends_m = ending_moments_m();
  ASSERT_FALSE(ends_m.empty());
  YawScrub scrub = scrub_of({0.5 * ends_m.front(), 0.9 * ends_m.front()});
  scrub.changing_m = Interval{0.1 * ends_m.front(), 3.0 * ends_m.back()};
  EXPECT_THAT(comparison_table(table_with(scrub)),
              HasSubstr("still ahead in 0, no longer in 0, undecided in 1"));
}

TEST(BreakEven, IsNotKeptAboveTheLargestMomentWithoutATurn) {
  const std::vector<double> ends_m = ending_moments_m();
  ASSERT_FALSE(ends_m.empty());
  const YawScrub moving = scrub_of({0.5 * ends_m.front(), 0.9 * ends_m.front()});
  EXPECT_THAT(comparison_table(table_with(moving, 2.0 * ends_m.back())),
              HasSubstr("still ahead in 0, no longer in 0, undecided in 1"));
  // If the vehicle never turned in the trials, the largest moment of the trials is a lower bound of
  // the scrub moment.
  EXPECT_THAT(comparison_table(table_with(std::nullopt, 2.0 * ends_m.back())),
              HasSubstr("still ahead in 0, no longer in 1, undecided in 0"));
  EXPECT_THAT(comparison_table(table_with(std::nullopt, 0.5 * ends_m.front())),
              HasSubstr("still ahead in 0, no longer in 0, undecided in 1"));
}

TEST(BreakEven, ReportsTheNumberOfTurnsForADecision) {
  const std::vector<double> ends_m = ending_moments_m();
  ASSERT_FALSE(ends_m.empty());
  const double end_m = ends_m.front();
  // The break-even moment is half-way from the middle of the interval to its end. Half the width of
  // the interval would decide. The width falls with the square root of the number of turns, so this
  // takes four times as many: 40.
  const Comparison comparison =
      table_with(scrub_of({0.9 * end_m - 0.2 * end_m, 0.9 * end_m + 0.2 * end_m}));
  for (const BreakEven& entry : *comparison.break_even) {
    if (entry.yaw_coulomb_m == end_m) {
      EXPECT_NEAR(entry.turns_to_decide.value_or(0), 40, 1);
    }
  }
  EXPECT_THAT(comparison_table(comparison), HasSubstr("differential turns in total would decide"));
}

TEST(BreakEven, RefusesYawResistanceThatIncludesScrub) {
  Model model = uncertain_model();
  model.yaw_by_sides_alone = true;
  const auto comparison = compare(model, kPaperGains, {turn(60.0)}, {.break_even = true});
  ASSERT_FALSE(comparison);
  EXPECT_THAT(to_text(comparison.error()), HasSubstr("add steered turns"));
}

}  // namespace
}  // namespace awmr::testing
