/// Score of a run, computed from the metrics that rank modes; lower is better. Private to compare/.
#pragma once

#include <vector>

#include "awmr/compare/preferences.h"
#include "awmr/compare/statistics.h"

namespace awmr {

/// Returns the weight of a metric, >= 0: from the preferences, else the metric's default. 0 for a
/// metric that is never used to rank modes.
double weight_of(const MetricColumn& metric, const Preferences& preferences);

/// A metric in the score of one scenario.
struct ScoredMetric {
  const MetricColumn* metric = nullptr;
  double weight = 0.0;  ///< weight w, >= 0
  double offset = 0.0;  ///< offset f of log_loss(), in the metric's unit, > 0
  /// Value that a run without this metric gets: the largest value of all counted runs
  /// (ModeRows::counted)
  double missing = 0.0;
};

/// Returns the metrics that can be used to rank modes and that any run of the scenario has, with
/// the weights of weight_of(), which can be 0.
std::vector<ScoredMetric> rankable_metrics(const ScenarioRows& scenario,
                                           const Preferences& preferences);

/// Returns the rankable metrics with a weight above 0, their weights divided by the sum.
std::vector<ScoredMetric> scoring_of(const ScenarioRows& scenario, const Preferences& preferences);

/// Loss of a run in one metric, ln(x + f): x is the value of the metric (0 if negative), and the
/// offset f is the metric's floor divided by the relevance margin. If f were not added, ratios of
/// small values would dominate the score. Because f is added, an increase of x by floor + relevance
/// x always multiplies x + f by 1 + relevance.
double log_loss(const Metrics& metrics, const ScoredMetric& scored);

/// Mean of log_loss() over the counted runs of a mode (ModeRows::counted).
double mean_log_loss(const ModeRows& rows, const ScoredMetric& scored);

/// Score of a run, lower is better: the weighted sum of log_loss() over its metrics. If the score
/// is larger by D, the weighted geometric mean of the values x + f (log_loss()) is exp(D) times as
/// large.
double log_score(const Metrics& metrics, const std::vector<ScoredMetric>& scoring);

/// log_score() of each counted run of a mode (ModeRows::counted).
std::vector<double> log_scores(const ModeRows& rows, const std::vector<ScoredMetric>& scoring);

}  // namespace awmr
