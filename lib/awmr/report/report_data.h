/// Reader of a directory of results, for the page and the figures. Private to report/.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/json/json.h"
#include "awmr/model/model.h"

namespace awmr {

/// Content of a directory of results.
struct ReportData {
  Model model;
  /// The data of the page, by key:
  /// - "model", "gains", "validation", "comparison", "pil", "suggest": content of the file of this
  ///   name, if it exists;
  /// - "samples": content of comparison.csv; "runs" and "scenarios": see run_data.h; "fits": see
  ///   drawn_fit.h;
  /// - "metric_words": names and units of the metrics; "header": true if awmr_params.h exists;
  /// - "yaw_rate_measured_degps": highest yaw rate with a measured resistance;
  /// - "findings": the findings of all files, those with the largest effect on the results first.
  Json json;
  /// A warning for each result that is not in `json`: it was made from another model or other gains
  /// than those in the directory (`result-of-another-model`), or the file that names its inputs is
  /// missing or belongs to another result (`result-without-origin`).
  std::vector<Finding> left_out = {};
};

/// Reads the directory. Errors (input): there is no model.json, or a file is invalid.
Result<ReportData> read_report_data(const std::filesystem::path& directory);

}  // namespace awmr
