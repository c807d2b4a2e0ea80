#include "awmr/compare/scoring.h"

#include <algorithm>
#include <cmath>

namespace awmr {
namespace {

double worst_of(const ScenarioRows& scenario, const MetricColumn& metric) {
  double worst = 0.0;
  for (const ModeRows& rows : scenario.modes) {
    for (const ComparisonRow& row : rows.counted()) {
      worst = std::max(worst, metric.value(row.metrics).value_or(0.0));
    }
  }
  return worst;
}

}  // namespace

double weight_of(const MetricColumn& metric, const Preferences& preferences) {
  if (!metric.can_rank()) return 0.0;
  const auto given = preferences.weights.find(metric.name);
  return given == preferences.weights.end() ? metric.default_weight : given->second;
}

std::vector<ScoredMetric> rankable_metrics(const ScenarioRows& scenario,
                                           const Preferences& preferences) {
  std::vector<ScoredMetric> rankable;
  for (const MetricColumn& metric : kMetricColumns) {
    if (!metric.can_rank() || !any_has(scenario, metric)) continue;
    rankable.push_back({.metric = &metric,
                        .weight = weight_of(metric, preferences),
                        .offset = metric.ranking_floor / preferences.relevance,
                        .missing = worst_of(scenario, metric)});
  }
  return rankable;
}

std::vector<ScoredMetric> scoring_of(const ScenarioRows& scenario, const Preferences& preferences) {
  std::vector<ScoredMetric> scoring = rankable_metrics(scenario, preferences);
  std::erase_if(scoring, [](const ScoredMetric& scored) { return !(scored.weight > 0.0); });
  double sum = 0.0;
  for (const ScoredMetric& scored : scoring) sum += scored.weight;
  for (ScoredMetric& scored : scoring) scored.weight /= sum;
  return scoring;
}

double log_loss(const Metrics& metrics, const ScoredMetric& scored) {
  const double value = scored.metric->value(metrics).value_or(scored.missing);
  return std::log(std::max(value, 0.0) + scored.offset);
}

double mean_log_loss(const ModeRows& rows, const ScoredMetric& scored) {
  double sum = 0.0;
  for (const ComparisonRow& row : rows.counted()) sum += log_loss(row.metrics, scored);
  return sum / static_cast<double>(rows.counted().size());
}

double log_score(const Metrics& metrics, const std::vector<ScoredMetric>& scoring) {
  double sum = 0.0;
  for (const ScoredMetric& scored : scoring) sum += scored.weight * log_loss(metrics, scored);
  return sum;
}

std::vector<double> log_scores(const ModeRows& rows, const std::vector<ScoredMetric>& scoring) {
  std::vector<double> scores;
  for (const ComparisonRow& row : rows.counted()) scores.push_back(log_score(row.metrics, scoring));
  return scores;
}

}  // namespace awmr
