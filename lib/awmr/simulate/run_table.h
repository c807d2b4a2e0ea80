/// Reads run.csv.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"

namespace awmr {

/// Reads the columns of run.csv that every run has: time, state, commands and references. Errors:
/// those of read_csv(); the time decreases.
Result<CsvTable> read_run(const std::filesystem::path& path);

/// Checks that the text of a run.csv can be read, before it is written (ReadBack in core/file.h).
/// Errors: those of read_run().
Status check_run_text(std::string_view text, const std::string& file);

}  // namespace awmr
