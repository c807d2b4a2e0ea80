/// Weights of the metrics in the ranking, and the relevance margin.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/number_rule.h"
#include "awmr/core/result.h"

namespace awmr {

/// Largest weight that a user can give. Weights only have an effect relative to each other.
inline constexpr double kMaximumWeight = 1000.0;
/// Permitted range of Preferences::relevance. With a margin below this range, all scores would be
/// nearly equal, because the offset floor/relevance is added to each metric (scoring.h). At a
/// margin of 0.001, the offset is already above most values of the metrics. At a margin of 0,
/// rounding errors could decide a rank.
inline constexpr NumberRule kRelevance{.min = 0.001, .max = 1.0};

struct Preferences {
  /// Weights by name of the metric, in [0, kMaximumWeight]. A metric that is not in the map has its
  /// default weight (metric_columns.h).
  std::map<std::string, double, std::less<>> weights;
  /// Relevance margin, in kRelevance. Two values of a metric count as equal if their relative
  /// difference is at most this margin, or their difference at most the metric's floor
  /// (MetricColumn).
  double relevance = 0.05;
  friend bool operator==(const Preferences&, const Preferences&) = default;
};

/// Returns the fault of a relevance margin that is outside kRelevance; absent if it is inside.
std::optional<Fault> relevance_fault(double relevance);

/// Reads weights of the form "NAME=WEIGHT". Errors (input): a text of another form; a metric that
/// is unknown or never ranked (the message has the nearest name); a weight outside its range; a
/// metric with two weights; no metric with a weight above 0; `relevance` outside kRelevance.
Result<Preferences> preferences_of(const std::vector<std::string>& weights, double relevance);

}  // namespace awmr
