/// Evaluation of tuning goals (TuningGoal), such as "95 % of the draws settle within 2 s and
/// overshoot by at most 1 deg". A draw is a vehicle that is drawn from the model's covariance.
/// Private to tune/.
///
/// The excess of a run is e = max_i x_i/l_i: the largest ratio of a metric x_i to its limit l_i. It
/// is infinite if the run breaks off or a metric is not finite. The excess of a draw is the largest
/// over its scenarios. In the search, a goal that requires the share p of the draws is met in a
/// mode if the p quantile of e over all draws is at most 1. The p quantile of n draws is the ceil(p
/// n)-th smallest value: with few draws, the largest. After the search, the verdict (GoalVerdict)
/// follows from the 95 % interval of the share of new draws that meet the goal.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Number of metrics that goals can limit; run_figure_names() has their names in tune.json.
inline constexpr std::size_t kRunFigures = 6;
std::vector<std::string> run_figure_names();

/// The metrics of a run that goals can limit and the evaluation reports. The objective uses other
/// metrics (kObjectiveTerms).
struct RunOutcome {
  YawMode mode{};
  bool completed = false;  ///< true if the run settles after every heading step
  bool broke_off = false;  ///< true: the run broke off, so the metrics end there
  /// Values of the metrics, in the order of run_figure_names(). The settling time of a run that
  /// does not settle is the scenario's duration.
  std::array<double, kRunFigures> figures{};
};
/// The runs of one set of gains, sorted by drawn vehicle, then mode, then scenario.
struct EvaluatedRuns {
  std::string gains;  ///< name of the gains, as in EvaluatedGains::gains
  std::vector<RunOutcome> outcomes;
};

/// Selects the metrics that goals and evaluation need from the score of a run.
RunOutcome outcome_of(const ModeScore& score, const Scenario& scenario);
/// outcome_of() for many runs. `scores` are sorted by drawn vehicle, then mode, then scenario.
std::vector<RunOutcome> outcomes_of(std::span<const ModeScore> scores,
                                    std::span<const Scenario> scenarios);

/// Describes a goal: "settling_time_s <= 2, overshoot_deg <= 1 in 95 % of draws".
std::string in_words(const TuningGoal& goal);

/// Returns the excess of a run, >= 0: the largest ratio of a metric to its limit in the goal. It is
/// at most 1 if the run meets every limit.
double excess_of(const TuningGoal& goal, const RunOutcome& outcome);

/// A goal in one of the modes in which it must be met.
struct GoalInMode {
  const TuningGoal* goal = nullptr;
  YawMode mode{};
  std::string name() const;  ///< name of the goal in constraints and messages
};
/// Returns each goal once for each of `modes` in which it must be met, sorted by goal, then mode.
std::vector<GoalInMode> by_mode(std::span<const TuningGoal> goals, std::span<const YawMode> modes);

/// Returns the p quantile of the excess over the drawn vehicles in the mode of `one`, >= 0, with p
/// the goal's required share. The goal is met if the quantile is at most 1. `outcomes` are sorted
/// by drawn vehicle, then mode, then scenario.
double quantile_of_excess(const GoalInMode& one, std::span<const RunOutcome> outcomes,
                          std::size_t scenarios);

EvaluatedGoal evaluate_goal(const GoalInMode& one, const EvaluatedRuns& runs,
                            std::size_t scenarios);

}  // namespace awmr
