/// One number for how well a run was driven, from the metrics that rank. Private to this folder.
#pragma once

#include <vector>

#include "awmr/compare/preferences.h"
#include "awmr/compare/statistics.h"

namespace awmr {

/// >= 0, the user's or the metric's own; 0 for a metric that cannot rank.
double weight_of(const MetricColumn& metric, const Preferences& preferences);

/// A metric as it counts in one scenario.
struct ScoredMetric {
  const MetricColumn* metric = nullptr;
  double weight = 0.0;   ///< in (0, 1], the weights of a scenario sum to 1
  double offset = 0.0;   ///< f of log_loss(), in the metric's unit, > 0
  double missing = 0.0;  ///< value for a run without the metric: the worst of all runs
};

/// The metrics with a weight that some run of the scenario has. Empty where there is none.
std::vector<ScoredMetric> scoring_of(const ScenarioRows& scenario, const Preferences& preferences);

/// ln(x + f), f the metric's floor over the relevance: steps of x that matter, floor + relevance x, count
/// alike at every x, each as much as the relevance. A ratio of two small numbers is no large step.
double log_loss(const Metrics& metrics, const ScoredMetric& scored);

/// Sum of w ln(x + f): of two runs, exp of the difference is the weighted geometric mean of the
/// metrics' ratios, which no third run has a say in.
double log_score(const Metrics& metrics, const std::vector<ScoredMetric>& scoring);

/// By counted run.
std::vector<double> log_scores(const ModeRows& rows, const std::vector<ScoredMetric>& scoring);

}  // namespace awmr
