/// Readable names and units of the metrics of a comparison. Private to report/.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/json/json.h"

namespace awmr {

/// Readable name and unit of a metric.
struct MetricWords {
  std::string words;  ///< readable name: "settling time"
  std::string unit;   ///< unit, such as "s"; empty if dimensionless
};

/// Returns readable name and unit of a metric. `name`: the name of the metric in comparison.json.
/// An unknown metric keeps this name and has an empty unit.
MetricWords metric_words(std::string_view name);

/// Readable names and units of all metrics as JSON for the page: {"settling_time_s": "settling
/// time, s", ...}.
Json metric_words_json();

}  // namespace awmr
