/// Which mode did best in a scenario. Private to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/statistics.h"

namespace awmr {

struct RankedMode {
  int rank = 0;  ///< 1 is best; tied modes share a rank
  YawMode mode{};
  double score = 0.0;  ///< in [0, 1], lower is better
  double completed_share = 0.0;
  std::vector<YawMode> tied_with;
};

/// Scores nearer than this are a tie: one metric in ten being 10 % better decides nothing.
inline constexpr double kTieMargin = 0.01;
inline constexpr std::string_view kScoreFormula =
    "mean over the ranked metrics i of x_i/max(w_i, f_i): x the mode's mean, w the worst mode's, f "
    "a "
    "floor below which the metric does not matter; a metric that the mode lacks and another has "
    "counts 1; the larger share of completed runs ranks first, whatever the score; scores within "
    "0.01 of the best of their rank tie";

/// Best first. Empty for a scenario that has nothing to follow (open loop), where lower metrics are
/// no better.
std::vector<RankedMode> rank(const ScenarioRows& scenario);

}  // namespace awmr
