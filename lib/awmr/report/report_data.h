/// What a directory of results holds, read once for the page and the figures. Private to this
/// folder.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/model.h"

namespace awmr {

struct ReportData {
  Model model;
  /// As the page takes it: the files that are there under their names ("model", "gains",
  /// "validation", "comparison", "pil", "suggest"), "samples" of comparison.csv, "runs" and
  /// "scenarios" (run_data.h), "fits" (drawn_fit.h), "metric_words", "header", and "findings" of all of
  /// them, those that change the numbers most first.
  Json json;
  /// A warning for each result that was made from another model or gains than those in the directory
  /// (`result-of-another-model`), or that does not say from which (`result-without-origin`). None of
  /// them is in `json`.
  std::vector<Finding> left_out = {};
};

/// Errors (input): no model.json, or a file is broken.
Result<ReportData> read_report_data(const std::filesystem::path& directory);

}  // namespace awmr
