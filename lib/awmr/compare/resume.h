/// Writes the files of a comparison, and reads them to resume one that was stopped.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// Reads the rows of an existing comparison.csv. The inputs and options in its comparison.json must
/// be the same, except for the numbers of samples and threads. Errors (input): the files are
/// missing or malformed, or from another comparison, program version or arithmetic.
Result<std::vector<ComparisonRow>> read_finished(const std::filesystem::path& directory,
                                                 const Provenance& provenance);

/// Reads the text of a comparison.csv. `file`: its name in errors. Errors (input): other columns,
/// or an invalid row.
Result<std::vector<ComparisonRow>> comparison_rows(std::string_view text, const std::string& file);

/// Read-back (core/file.h) of comparison.csv.
Status check_comparison_csv(std::string_view text, const std::string& file);

/// Files of a comparison in its directory.
inline constexpr const char* kComparisonTable = "comparison.csv";
inline constexpr const char* kComparisonJson = "comparison.json";

/// Writes both files into the directory, which is created if necessary. `document` is the text of
/// comparison.json. Errors: as write_files().
Status write_comparison(const std::filesystem::path& directory, const Comparison& comparison,
                        const std::string& document);

}  // namespace awmr
