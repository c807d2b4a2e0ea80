#include "awmr/compare/ranking.h"

#include <algorithm>

namespace awmr {
namespace {

/// True where some mode was judged by how well it followed a command.
bool has_a_goal(const ScenarioRows& scenario) {
  return std::any_of(scenario.modes.begin(), scenario.modes.end(), [](const ModeRows& rows) {
    const Metrics& m = rows.nominal();
    return m.heading_iae_degs || m.cross_track_rms_m || m.finish_time_s;
  });
}

std::vector<double> scores_of(const ScenarioRows& scenario) {
  std::vector<double> sums(scenario.modes.size(), 0.0);
  int metrics = 0;
  for (const MetricColumn& metric : kMetricColumns) {
    if (!(metric.ranking_floor > 0.0)) continue;
    std::vector<std::optional<double>> means;
    double worst = metric.ranking_floor;
    bool any = false;
    for (const ModeRows& rows : scenario.modes) {
      means.push_back(summarise(rows, metric).mean);
      any = any || means.back();
      worst = std::max(worst, means.back().value_or(0.0));
    }
    if (!any) continue;
    ++metrics;
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += means[i] ? *means[i] / worst : 1.0;
  }
  for (double& sum : sums) sum /= metrics > 0 ? metrics : 1;
  return sums;
}

}  // namespace

std::vector<RankedMode> rank(const ScenarioRows& scenario) {
  if (!has_a_goal(scenario)) return {};
  const std::vector<double> scores = scores_of(scenario);
  std::vector<RankedMode> ranked;
  for (std::size_t i = 0; i < scenario.modes.size(); ++i) {
    ranked.push_back({.rank = 0,
                      .mode = scenario.modes[i].mode,
                      .score = scores[i],
                      .completed_share = scenario.modes[i].completed_share(),
                      .tied_with = {}});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedMode& a, const RankedMode& b) {
    if (a.completed_share > b.completed_share) return true;
    if (a.completed_share < b.completed_share) return false;
    return a.score < b.score;
  });
  std::size_t leader = 0;  // the best of the current rank
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const bool ties = !(ranked[i].completed_share < ranked[leader].completed_share) &&
                      ranked[i].score - ranked[leader].score <= kTieMargin;
    if (!ties) leader = i;
    ranked[i].rank = static_cast<int>(leader) + 1;
  }
  for (RankedMode& mode : ranked) {
    for (const RankedMode& other : ranked) {
      if (other.rank == mode.rank && other.mode != mode.mode) mode.tied_with.push_back(other.mode);
    }
  }
  return ranked;
}

}  // namespace awmr
