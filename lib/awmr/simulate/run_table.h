/// Reads run.csv.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"

namespace awmr {

/// Reads time, state, commands and references from run.csv: columns that every run has. Errors:
/// those of read_csv(); decreasing time.
Result<CsvTable> read_run(const std::filesystem::path& path);

/// Checks the text of a run.csv by parsing it: the ReadBack (core/file.h) of this format. Errors:
/// those of read_run().
Status check_run_text(std::string_view text, const std::string& file);

}  // namespace awmr
