/// Ranking of the modes in a scenario, with its uncertainty. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/preferences.h"
#include "awmr/compare/statistics.h"

namespace awmr {

struct RankedMode {
  int rank = 0;  ///< >= 1, 1 is best; tied modes share a rank
  Contender contender;
  /// Weighted geometric mean of the ranked metrics, each with its offset (scoring.h), relative to
  /// the first mode of the list. Below 1 for a mode with a better score that fails more often.
  double score = 1.0;
  double completed_share = 0.0;         ///< in [0, 1]
  std::optional<Interval> behind_ci95;  ///< of the score; absent for the first and below 2 samples
  /// Compared with the best of the rank above, or of its own rank if tied (relevant: it is worse);
  /// absent for the first.
  std::optional<Conclusion> towards_leader;
  std::vector<std::string> tied_with;  ///< labels of the others of its rank
  /// Shares in [0, 1] of random weights, and of the samples (absent below 2), for which the mode
  /// has the best score among those that complete as often as the best. Modes within `relevance` of
  /// the best, and modes tied for rank 1, share the count.
  double first_by_weights = 0.0;
  std::optional<double> first_by_samples;
  /// Labels of modes that are relevantly better in a ranked metric and relevantly worse in none.
  std::vector<std::string> dominated_by;
};

inline constexpr std::string_view kScoreFormula =
    "weighted geometric mean over the ranked metrics of (x + f)/(x1 + f): x the mode's, x1 that of "
    "the first mode, f the metric's floor over the relevance; by sample, a metric that a run lacks "
    "counts as the "
    "worst "
    "run's. A mode is behind where the whole 95 % interval of its score over the leader's "
    "(bootstrap "
    "over samples, widened for few by Student's t) is above 1 + relevance; equivalent where the 90 "
    "% interval is within relevance "
    "of 1, or every ranked metric by itself; "
    "else undecided, and with the leader of its rank. Modes that complete less often than the "
    "best, by "
    "the exact McNemar test, come after those that do not";

inline constexpr std::string_view kNotRanked =
    "not ranked: the scenario gives the vehicle nothing to follow, or none of the metrics that "
    "have a weight";

/// True if any mode has a heading error, a cross-track error or a finish time.
bool has_a_goal(const ScenarioRows& scenario);

/// Ranks the modes, best first. Empty for a scenario without a target (open loop), in which lower
/// metrics are not better, and if no ranked metric has a weight. `differences`:
/// paired_differences() of the same scenario. `seed`: of the bootstrap, the same in every scenario.
std::vector<RankedMode> rank(const ScenarioRows& scenario,
                             const std::vector<PairedDifference>& differences,
                             const Preferences& preferences = {}, std::uint64_t seed = 1);

}  // namespace awmr
