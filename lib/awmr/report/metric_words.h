/// What the metrics of a comparison are called in words. Private to this folder.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/json.h"

namespace awmr {

struct MetricWords {
  std::string words;  ///< "settling time"
  std::string unit;   ///< "s"; empty where dimensionless
};

/// Of a name as in comparison.json; a metric that is not known is called by its name.
MetricWords metric_words(std::string_view name);

/// All of them as the page takes them: {"settling_time_s": "settling time, s", ...}.
Json metric_words_json();

}  // namespace awmr
