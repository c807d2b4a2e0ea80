/// Readable names and units of the metrics of a comparison. Private to report/.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/json.h"

namespace awmr {

/// Readable name and unit of a metric.
struct MetricWords {
  std::string words;  ///< "settling time"
  std::string unit;   ///< "s"; empty if dimensionless
};

/// Returns the words for a metric's name in comparison.json. An unknown metric keeps its name.
MetricWords metric_words(std::string_view name);

/// The words of all metrics, as the page needs them: {"settling_time_s": "settling time, s", ...}.
Json metric_words_json();

}  // namespace awmr
