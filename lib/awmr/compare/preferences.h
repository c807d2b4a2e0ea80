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
  /// By metric's name, in [0, kMaximumWeight]; those that are not here have their default
  /// (metric_columns.h).
  std::map<std::string, double, std::less<>> weights;
  /// In [0, 1], 1: a metric that differs by less than this share, or by less than the metric's floor,
  /// is the same for all practical purposes.
  double relevance = 0.05;
  friend bool operator==(const Preferences&, const Preferences&) = default;
};

/// Reads weights of the form "NAME=WEIGHT". Errors (input): another form, an unknown or unranked
/// metric (with the nearest name), a weight outside its range, a duplicate name; no metric with a
/// weight above 0.
Result<Preferences> preferences_of(const std::vector<std::string>& weights, double relevance);

/// The names that weights may have, in the order of comparison.csv.
std::vector<std::string_view> weighable_metrics();

}  // namespace awmr
