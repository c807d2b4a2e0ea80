/// The modes of a scenario in the order of their scores. Private to compare/.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "awmr/compare/mode_rows.h"
#include "awmr/compare/scoring.h"

namespace awmr {

/// A mode to be ranked, with the logarithms from which its score is computed.
struct RankingEntry {
  std::size_t mode = 0;  ///< index in ScenarioRows::modes
  const ModeRows* rows = nullptr;
  /// log_score() of each run in the statistics (ModeRows::counted).
  std::vector<double> log_scores;
  std::vector<double> mean_losses;  ///< for each scored metric, mean log_loss() over the same runs
  /// False if the mode completes significantly fewer runs than the mode with the most completed
  /// runs, or no run although another mode completes some.
  bool completes = true;

  double log_score() const { return mean(log_scores); }

  static double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
};

/// True if two modes complete the scenario about equally often: the exact McNemar test, which
/// compares the runs sample by sample, finds no significant difference. False if only one mode
/// completes any run. If there is only one run, both modes or neither must complete it.
bool complete_alike(const ModeRows& a, const ModeRows& b);

/// Returns the modes of a scenario, best first. Modes that complete often enough
/// (RankingEntry::completes) come first, sorted by score; the other modes follow, sorted by number
/// of completed runs.
std::vector<RankingEntry> sorted_entries(const ScenarioRows& scenario,
                                         const std::vector<ScoredMetric>& scoring);

}  // namespace awmr
