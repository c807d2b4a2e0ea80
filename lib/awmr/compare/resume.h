/// Files of a comparison: written, and read back to continue one that was stopped.
#pragma once

#include <filesystem>
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

/// The rows of the text of a comparison.csv; `file` names it in errors. Errors (input): it has other
/// columns, or a row is not one of a comparison.
Result<std::vector<ComparisonRow>> comparison_rows(std::string_view text, const std::string& file);

/// Read-back (core/file.h) of comparison.csv.
Status check_comparison_csv(std::string_view text, const std::string& file);

/// Files of a comparison in its directory.
inline constexpr const char* kComparisonTable = "comparison.csv";
inline constexpr const char* kComparisonJson = "comparison.json";

/// Writes both files into the directory, which is made if necessary. `document` is the text of
/// comparison.json. Errors: as write_files().
Status write_comparison(const std::filesystem::path& directory, const Comparison& comparison,
                        const std::string& document);

}  // namespace awmr
