/// Writes comparison.csv and comparison.json, and reads the rows of comparison.csv.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/result.h"

namespace awmr {

/// Reads the rows from the text of a comparison.csv. `file`: its name in errors. Errors (input):
/// other columns, or an invalid row.
Result<std::vector<ComparisonRow>> comparison_rows(std::string_view text, const std::string& file);

/// Checks that a text is a valid comparison.csv, before it is written (ReadBack in core/file.h).
/// Errors: those of comparison_rows().
Status check_comparison_csv(std::string_view text, const std::string& file);

/// Names of the files of a comparison in its directory.
inline constexpr const char* kComparisonTable = "comparison.csv";
inline constexpr const char* kComparisonJson = "comparison.json";

/// Writes both files into the directory, which is created if necessary. `document`:
/// comparison.json. Errors: those of write_files().
Status write_comparison(const std::filesystem::path& directory, const Comparison& comparison,
                        const std::string& document);

}  // namespace awmr
