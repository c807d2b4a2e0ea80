/// Which mode did best in a scenario, and how sure that is. Private to this folder.
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
  /// Weighted geometric mean of the ranked metrics, each with its offset (scoring.h), over those of the
  /// first of the list. Below 1 where a mode has the better score and fails more often.
  double score = 1.0;
  double completed_share = 0.0;         ///< in [0, 1]
  std::optional<Interval> behind_ci95;  ///< of the score; absent for the first and below 2 samples
  /// Towards the best of the rank above, or of its own rank where it is tied (relevant: behind it);
  /// absent for the first.
  std::optional<Conclusion> towards_leader;
  std::vector<std::string> tied_with;  ///< labels of the others of its rank
  /// Shares in [0, 1] in which the mode has the best score of all that complete as often as the
  /// best does: of weights drawn at random, and of the samples (absent below 2). Modes within
  /// `relevance` of the best share it, and so do modes that tie for the first place.
  double first_by_weights = 0.0;
  std::optional<double> first_by_samples;
  /// Labels of modes that are relevantly better in a ranked metric and in none relevantly worse.
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

/// Whether any mode has a metric of how well it followed a command.
bool has_a_goal(const ScenarioRows& scenario);

/// Best first. Empty for a scenario that has nothing to follow (open loop), where lower metrics are
/// no better, and where no ranked metric has a weight. `differences` are paired_differences() of the
/// same scenario; `seed` is that of the bootstrap, which is the same in every scenario.
std::vector<RankedMode> rank(const ScenarioRows& scenario,
                             const std::vector<PairedDifference>& differences,
                             const Preferences& preferences = {}, std::uint64_t seed = 1);

}  // namespace awmr
