/// Weights of the metrics in the ranking, and the relevance margin.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

inline constexpr double kMaximumWeight = 1000.0;

struct Preferences {
  /// Weights by name of the metric, in [0, kMaximumWeight]. A metric that is not listed has its
  /// default weight (metric_columns.h).
  std::map<std::string, double, std::less<>> weights;
  /// Relevance margin: relative differences up to this do not matter, in [0, 1]. Neither do
  /// differences up to the metric's floor (MetricColumn::ranking_floor).
  double relevance = 0.05;
  friend bool operator==(const Preferences&, const Preferences&) = default;
};

/// Reads weights of the form "NAME=WEIGHT". Errors (input): a text of another form; a metric that
/// is unknown or never ranked (the message has the nearest name); a weight outside its range; a
/// metric with two weights; no metric with a weight above 0; `relevance` outside [0, 1].
Result<Preferences> preferences_of(const std::vector<std::string>& weights, double relevance);

}  // namespace awmr
