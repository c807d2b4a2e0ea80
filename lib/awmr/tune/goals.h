/// Evaluation of tuning goals (TuningGoal), such as "95 % of the draws settle within 2 s and
/// overshoot by at most 1 deg". Private to tune/.
///
/// The excess of a run is e = max_i x_i/l_i, with x_i its metrics and l_i their limits. It is
/// infinite if the run breaks off. The excess of a draw is the largest over the scenarios. A goal
/// with the share p is met in a mode if the p quantile of e over all draws is at most 1. The p
/// quantile of n draws is the ceil(p n)-th smallest value, so with few draws it is the largest.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns the metrics of a run that goals and evaluation need.
RunOutcome outcome_of(const ModeScore& score, const Scenario& scenario);
/// The same for many runs. `scores` are by draw, then mode, then scenario.
std::vector<RunOutcome> outcomes_of(std::span<const ModeScore> scores,
                                    std::span<const Scenario> scenarios);

/// Value of a metric for a run. Precondition: the metric exists.
double figure_of_run(std::string_view name, const RunOutcome& outcome);

/// "settling_time_s <= 2, overshoot_deg <= 1 in 95 % of draws"
std::string in_words(const TuningGoal& goal);

/// Largest ratio of a run's metric to its limit, >= 0. At most 1 if the run meets the goal.
double excess_of(const TuningGoal& goal, const RunOutcome& outcome);

/// A goal in one of its modes.
struct GoalInMode {
  const TuningGoal* goal = nullptr;
  YawMode mode{};
  std::string name() const;  ///< for constraints and messages
};
/// By goal, then mode.
std::vector<GoalInMode> by_mode(std::span<const TuningGoal> goals, std::span<const YawMode> modes);

/// Returns the quantile of the excess in the mode over the draws, >= 0. `outcomes` are by draw, then
/// mode, then scenario.
double quantile_of_excess(const GoalInMode& one, std::span<const RunOutcome> outcomes,
                          std::size_t scenarios);

/// Counts the draws that meet the goal in the mode, and gives the verdict.
EvaluatedGoal evaluate_goal(const GoalInMode& one, const EvaluatedRuns& runs,
                            std::size_t scenarios);

}  // namespace awmr
