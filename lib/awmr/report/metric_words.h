/// Readable names of the metrics of a comparison. Private to this folder.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/json.h"

namespace awmr {

struct MetricWords {
  std::string words;  ///< "settling time"
  std::string unit;   ///< "s"; empty if dimensionless
};

/// For a name as in comparison.json; an unknown metric keeps its name.
MetricWords metric_words(std::string_view name);

/// All of them in the form used by the page: {"settling_time_s": "settling time, s", ...}.
Json metric_words_json();

}  // namespace awmr
