/// Which mode did best in a scenario. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/statistics.h"

namespace awmr {

struct RankedMode {
  int rank = 0;  ///< >= 1, 1 is best; tied modes share a rank
  Contender contender;
  double score = 0.0;            ///< in [0, 1], lower is better
  double completed_share = 0.0;  ///< in [0, 1]
  /// Score above that of the best of its rank's leader, sample by sample; absent for the first of a
  /// rank and below 2 samples.
  std::optional<Interval> behind_ci95;
  std::vector<std::string> tied_with;  ///< labels of the others of its rank
};

/// Scores nearer than this are a tie: one metric in ten being 10 % better decides nothing.
inline constexpr double kTieMargin = 0.01;
inline constexpr std::string_view kScoreFormula =
    "mean over the ranked metrics i of x_i/max(w_i, f_i): x the mode's mean, w the worst mode's, f "
    "a floor below which the metric does not matter; a metric that the mode lacks and another has "
    "counts 1; the larger share of completed runs ranks first, whatever the score; a tie with the "
    "best of a rank: scores within 0.01, or with samples a bootstrap interval of their paired "
    "difference that holds 0, and shares of completed runs that are equal, or with samples not "
    "told apart by the exact McNemar test";

/// Best first. Empty for a scenario that has nothing to follow (open loop), where lower metrics are
/// no better. `seed` and `stream` are those of the bootstrap.
std::vector<RankedMode> rank(const ScenarioRows& scenario, std::uint64_t seed = 1,
                             std::uint64_t stream = 0);

/// What a metric's differences are measured in: the worst mode's mean, or the metric's floor.
double ranking_scale(const ScenarioRows& scenario, const MetricColumn& metric);

/// One sentence (or two) on who is best, by what, and how sure that is.
std::string verdict_of(const ScenarioRows& scenario, const std::vector<RankedMode>& ranking,
                       const std::vector<PairedDifference>& differences);

}  // namespace awmr
