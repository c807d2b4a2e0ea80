/// Ranking of the modes in a scenario, with its uncertainty. Private to compare/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/preferences.h"
#include "awmr/compare/statistics.h"

namespace awmr {

/// A mode (with its gains) in the ranking of a scenario.
struct RankedMode {
  int rank = 0;  ///< 1 is best; tied modes have the same rank
  Contender contender;
  /// Score of this mode divided by that of the first mode in the list; lower is better. A score is
  /// the weighted geometric mean of the metrics, each with an offset added (scoring.h). Can be
  /// below 1, because the first mode can have a worse score, but complete more runs.
  double score = 1.0;
  double completed_share = 0.0;  ///< share of completed runs, in [0, 1]
  /// 95 % interval of `score`; absent for the first mode, and below 2 samples.
  std::optional<Interval> behind_ci95;
  /// Conclusion from comparing this mode with its leader; absent for the first mode. The leader is
  /// the best mode of the same rank; for that best mode, the leader is the best mode of the rank
  /// above. kRelevant: this mode has a relevantly worse score, or completes significantly fewer
  /// runs, or no run although the leader completes some.
  std::optional<Conclusion> towards_leader;
  std::vector<std::string> tied_with;  ///< labels of the other modes of the same rank
  /// Share in [0, 1] of random weightings of the metrics with which this mode has the best score.
  /// first_by_samples: the same for the samples; absent below 2 samples.
  ///   - If the scores of several modes are within `relevance` of the best score, a weighting or
  ///     sample is divided equally among them.
  ///   - A mode that completes significantly less often has the shares 0.
  ///   - Modes that are tied for rank 1 get the mean of their shares of weightings and, if they are
  ///     equivalent, the mean of their shares of samples.
  double first_by_weights = 0.0;
  std::optional<double> first_by_samples;
  /// Labels of other modes that are relevantly better than this mode in a ranked metric, and
  /// relevantly worse in none.
  std::vector<std::string> dominated_by;
};

inline constexpr std::string_view kScoreFormula =
    "geometric mean over the samples of the weighted geometric mean over the ranked metrics of "
    "(x + f)/(x1 + f), x: the mode's value, x1: that of the first mode in the list, f: the "
    "metric's floor divided by the relevance. A metric that a run lacks counts as that of the "
    "worst run. The leader is the best mode of a rank. A mode is behind if the whole 95 % "
    "interval of the ratio of its score to the leader's is above 1 + relevance (bootstrap over "
    "samples, widened for few samples by Student's t). It is equivalent if the 90 % interval is "
    "within relevance of 1, or if every ranked metric is equivalent. Otherwise it is undecided "
    "and shares the rank of the leader. Modes that complete significantly less often than the "
    "best (exact McNemar test), or never although another mode does, come after the others. The "
    "scores include runs that were not completed";

inline constexpr std::string_view kNotRanked =
    "not ranked: the scenario has no heading, line, path or waypoints to follow, or no metric with "
    "a weight above 0 applies to it";

/// True if the scenario has a target (a heading, a path or an end), so that lower metrics are
/// better. Test: the nominal run of any mode has a heading error, a cross-track error or a finish
/// time.
bool has_a_goal(const ScenarioRows& scenario);

/// Ranks the modes, best first. Empty if no metric with a weight applies, or if the scenario has no
/// target (open loop), because lower metrics are then not better. `statistics`: statistics_of()
/// this scenario, with preferences of the same relevance. `seed`: seed of the random weightings.
std::vector<RankedMode> rank(const ScenarioRows& scenario, const ScenarioStatistics& statistics,
                             const Preferences& preferences = {}, std::uint64_t seed = 1);

}  // namespace awmr
