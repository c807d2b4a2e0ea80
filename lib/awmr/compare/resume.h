/// A comparison that was stopped, read back.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// The rows of a comparison.csv written before, and a check that its comparison.json is of the same
/// inputs and options; the numbers of samples and threads may differ. Errors (input): the files
/// are missing, malformed, of another comparison, of another version of the program or of other
/// arithmetic.
Result<std::vector<ComparisonRow>> read_finished(const std::filesystem::path& directory,
                                                 const Provenance& provenance);

/// The rows of a comparison.csv. Errors (input): it is missing, a row is not one of a comparison,
/// or its bytes are not those with the hash (none: not checked).
Result<std::vector<ComparisonRow>> read_rows(const std::filesystem::path& path,
                                             const std::optional<std::string>& sha256);

/// Read-backs (core/file.h) of comparison.csv and comparison.json, as a comparison is resumed.
Status check_comparison_csv(std::string_view text, const std::string& file);
Status check_comparison_text(std::string_view text, const std::string& file);

}  // namespace awmr
