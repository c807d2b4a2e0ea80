/// Evaluation of tuning goals (TuningGoal), such as "95 % of the draws settle within 2 s and
/// overshoot by at most 1 deg". Private to tune/.
///
/// The excess of a run is e = max_i x_i/l_i: the largest ratio of a metric x_i to its limit l_i. It
/// is infinite if the run breaks off or a metric is not finite. The excess of a draw is the largest
/// over its scenarios. In the search, a goal with the required share p is met in a mode if the p
/// quantile of e over all draws is at most 1. The p quantile of n draws is the ceil(p n)-th
/// smallest value, so with few draws it is the largest. After the search, the verdict (GoalVerdict)
/// follows from the 95 % interval of the share of new draws that meet the goal.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Metrics of a run that goals can limit ("figures", with their names in tune.json).
inline constexpr std::size_t kRunFigures = 6;  ///< number of names in run_figure_names()
bool is_run_figure(std::string_view name);
std::vector<std::string> run_figure_names();

/// Metrics of a run for goals and evaluation. The metrics of the objective are others
/// (kObjectiveTerms).
struct RunOutcome {
  YawMode mode{};
  bool completed = false;  ///< true if the run settles after every heading step
  bool broke_off = false;  ///< the run broke off; the metrics are those up to that time
  /// In the order of run_figure_names(). The settling time of a run that does not settle is the
  /// scenario's duration.
  std::array<double, kRunFigures> figures{};
};
/// The runs of one set of gains, sorted by draw, then mode, then scenario.
struct EvaluatedRuns {
  std::string gains;  ///< name of the gains, as in EvaluatedGains::gains
  std::vector<RunOutcome> outcomes;
};

/// Returns the metrics of a run that goals and evaluation need.
RunOutcome outcome_of(const ModeScore& score, const Scenario& scenario);
/// outcome_of() for many runs. `scores` are sorted by draw, then mode, then scenario.
std::vector<RunOutcome> outcomes_of(std::span<const ModeScore> scores,
                                    std::span<const Scenario> scenarios);

/// Describes a goal: "settling_time_s <= 2, overshoot_deg <= 1 in 95 % of draws".
std::string in_words(const TuningGoal& goal);

/// The excess of a run, >= 0 (see above). At most 1 if the run meets every limit of the goal.
double excess_of(const TuningGoal& goal, const RunOutcome& outcome);

/// A goal in one of the modes in which it must be met.
struct GoalInMode {
  const TuningGoal* goal = nullptr;
  YawMode mode{};
  std::string name() const;  ///< name of the goal in constraints and messages
};
/// Pairs each goal with each of its modes that is in `modes`. Sorted by goal, then mode.
std::vector<GoalInMode> by_mode(std::span<const TuningGoal> goals, std::span<const YawMode> modes);

/// Returns the quantile, over the draws, of the excess in the goal's mode, >= 0. The goal is met if
/// the quantile is at most 1. `outcomes` are sorted by draw, then mode, then scenario.
double quantile_of_excess(const GoalInMode& one, std::span<const RunOutcome> outcomes,
                          std::size_t scenarios);

/// Counts the draws that meet every limit of the goal in its mode, and determines the verdict.
EvaluatedGoal evaluate_goal(const GoalInMode& one, const EvaluatedRuns& runs,
                            std::size_t scenarios);

}  // namespace awmr
