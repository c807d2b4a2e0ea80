/// Contents of a directory of results, read once for the page and the figures. Private to this
/// folder.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/model.h"

namespace awmr {

struct ReportData {
  Model model;
  /// In the form used by the page: the existing files under their names ("model", "gains",
  /// "validation", "comparison", "pil", "suggest"), "samples" of comparison.csv, "runs" and
  /// "scenarios" (run_data.h), "fits" (drawn_fit.h), "metric_words", "header", and "findings" of
  /// all files, those with the largest effect on the numbers first.
  Json json;
  /// A warning for each result that was made from another model or gains than those in the
  /// directory (`result-of-another-model`), or that does not name its inputs
  /// (`result-without-origin`). `json` has none of these results.
  std::vector<Finding> left_out = {};
};

/// Errors (input): no model.json, or an invalid file.
Result<ReportData> read_report_data(const std::filesystem::path& directory);

}  // namespace awmr
