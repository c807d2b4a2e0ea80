#include <fmt/format.h>

#include <optional>
#include <utility>

#include "awmr/tune/goals.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/tuning_steps.h"

namespace awmr {
namespace {

void add_bounds(const Gains<double>& baseline, const GainBounds& bounds,
                std::vector<ConstraintReport>& all) {
  for (const SearchedGain& searched : kSearchedGains) {
    const std::optional<Interval>& range = bounds.*searched.bounds;
    const double gain = searched.of(baseline);
    if (!range || range->contains(gain)) continue;
    const std::string name = fmt::format("bounds/{}", searched.key);
    all.push_back(gain < range->lo ? at_least(name, gain, range->lo)
                                   : at_most(name, gain, range->hi));
  }
}

}  // namespace

std::vector<ConstraintReport> violated_by_baseline(const Gains<double>& baseline,
                                                   const Objective& objective,
                                                   const ConstraintContext& context,
                                                   const TuneOptions& requested) {
  std::vector<ConstraintReport> all;
  for (ConstraintReport& c : constraints_of(baseline, context)) {
    if (c.required && residual(c) > 0.0) all.push_back(std::move(c));
  }
  add_bounds(baseline, requested.bounds, all);
  // `activity_max` limits the control variation, as a multiple of its value with the baseline. The
  // baseline itself has the multiple 1, so it violates every limit below 1.
  if (requested.activity_max && *requested.activity_max < 1.0) {
    all.push_back(at_most("activity_max", 1.0, *requested.activity_max));
  }
  const std::vector<GoalInMode> goals = by_mode(objective.goals(), objective.modes());
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const double times_limits = objective.baseline().goal_quantile[i];
    if (goals[i].goal->is_soft || times_limits <= 1.0) continue;
    all.push_back(at_most(fmt::format("goal \"{}\", in multiples of its limits", goals[i].name()),
                          times_limits, 1.0));
  }
  return all;
}

}  // namespace awmr
