/// Score of a run, computed from the metrics that rank modes. Private to compare/.
#pragma once

#include <vector>

#include "awmr/compare/preferences.h"
#include "awmr/compare/statistics.h"

namespace awmr {

/// Weight of a metric, >= 0: the user's, or the metric's default; 0 for a metric that cannot rank.
double weight_of(const MetricColumn& metric, const Preferences& preferences);

/// A metric in the score of one scenario.
struct ScoredMetric {
  const MetricColumn* metric = nullptr;
  double weight = 0.0;   ///< w, in (0, 1]; the weights of a scenario sum to 1
  double offset = 0.0;   ///< f of log_loss(), in the metric's unit, > 0
  double missing = 0.0;  ///< value for a run without the metric: the worst of all runs
};

/// Returns the metrics with a weight above 0 that any run of the scenario has.
std::vector<ScoredMetric> scoring_of(const ScenarioRows& scenario, const Preferences& preferences);

/// Loss of one metric: ln(x + f), x its value, f its floor divided by the relevance. A difference of
/// floor + relevance x then changes the ratio (x + f) by the relevance for every x, and ratios of
/// small values do not dominate.
double log_loss(const Metrics& metrics, const ScoredMetric& scored);

/// Score of a run: the sum of w ln(x + f). For two runs, exp(difference of the scores) is the
/// weighted geometric mean of the ratios of their metrics, independent of other runs.
double log_score(const Metrics& metrics, const std::vector<ScoredMetric>& scoring);

/// Scores of the counted runs of a mode (ModeRows::counted).
std::vector<double> log_scores(const ModeRows& rows, const std::vector<ScoredMetric>& scoring);

}  // namespace awmr
