/// What a directory of results holds, read once for the page and the figures. Private to this
/// folder.
#pragma once

#include <filesystem>

#include "awmr/core/json.h"
#include "awmr/model/model.h"

namespace awmr {

struct ReportData {
  Model model;
  /// As the page takes it: the files that are there under their names ("model", "gains",
  /// "validation", "comparison", "pil", "suggest"), "samples" of comparison.csv, "runs" and
  /// "scenarios" (run_data.h), "fits" (drawn_fit.h), "metric_words" and "header".
  Json json;
};

/// Errors (input): no model.json, a file is broken, or a result was made from another model.json or
/// gains.json than the one beside it.
Result<ReportData> read_report_data(const std::filesystem::path& directory);

}  // namespace awmr
