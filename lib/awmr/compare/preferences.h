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
  /// By metric's name, in [0, kMaximumWeight]; missing ones have their default (metric_columns.h).
  std::map<std::string, double, std::less<>> weights;
  /// In [0, 1], dimensionless: relative differences below this, and differences below the metric's
  /// floor, are irrelevant.
  double relevance = 0.05;
  friend bool operator==(const Preferences&, const Preferences&) = default;
};

/// Reads weights of the form "NAME=WEIGHT". Errors (input): another form, an unknown or unranked
/// metric (with the nearest name), a weight outside its range, a duplicate name; no metric with a
/// weight above 0.
Result<Preferences> preferences_of(const std::vector<std::string>& weights, double relevance);

/// The allowed names of weights, in the order of comparison.csv.
std::vector<std::string_view> weighable_metrics();

}  // namespace awmr
