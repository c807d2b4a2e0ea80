/// report.html: one self-contained file from what lies in a directory of results.
#pragma once

#include <filesystem>
#include <string>

#include "awmr/core/result.h"

namespace awmr {

/// Reads model.json and, where present, gains.json, validation.json, comparison.json and .csv,
/// pil.json, suggest.json, the scenarios `scenario_<scenario>.json` and the runs
/// `run_<scenario>_<mode>_<tuned|paper>.csv`. Errors (input): no model.json, or a file is broken.
Result<std::string> report_html(const std::filesystem::path& directory);

}  // namespace awmr
