/// CSV that is in memory already.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"

namespace awmr {

/// As read_csv, from a text; `file` names it in errors.
Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings = {});

/// The beginning of a table.
struct CsvHead {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< the cells as they stand
  char delimiter = ',';
};

/// The header, found as read_csv_text() finds it, and up to `most_rows` rows. Errors: no header.
Result<CsvHead> csv_head(std::string_view bytes, const std::string& file,
                         std::span<const CsvColumn> columns,
                         std::span<const ColumnMapping> mappings, std::size_t most_rows);

/// The file's name without its directory, for findings, whose bytes are the same wherever the file
/// lies; errors show the path as typed.
std::string finding_file(const CsvTable& table);

}  // namespace awmr
