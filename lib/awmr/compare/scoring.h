/// Score of a run from the ranked metrics. Private to this folder.
#pragma once

#include <vector>

#include "awmr/compare/preferences.h"
#include "awmr/compare/statistics.h"

namespace awmr {

/// >= 0: the user's weight or the metric's default; 0 for a metric that cannot rank.
double weight_of(const MetricColumn& metric, const Preferences& preferences);

/// A metric in the score of one scenario.
struct ScoredMetric {
  const MetricColumn* metric = nullptr;
  double weight = 0.0;   ///< in (0, 1], the weights of a scenario sum to 1
  double offset = 0.0;   ///< f of log_loss(), in the metric's unit, > 0
  double missing = 0.0;  ///< value for a run without the metric: the worst of all runs
};

/// The metrics with a weight that any run of the scenario has.
std::vector<ScoredMetric> scoring_of(const ScenarioRows& scenario, const Preferences& preferences);

/// ln(x + f) with f the metric's floor divided by the relevance. A relevant difference, floor +
/// relevance x, then changes the score by the relevance at every x, and ratios of small numbers do
/// not dominate.
double log_loss(const Metrics& metrics, const ScoredMetric& scored);

/// Sum of w ln(x + f). For two runs, exp of the difference is the weighted geometric mean of the
/// metrics' ratios, independent of other runs.
double log_score(const Metrics& metrics, const std::vector<ScoredMetric>& scoring);

/// By counted run.
std::vector<double> log_scores(const ModeRows& rows, const std::vector<ScoredMetric>& scoring);

}  // namespace awmr
