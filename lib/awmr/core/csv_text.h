/// Reads CSV from memory.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"

namespace awmr {

/// Like read_csv(), but from text. `file` is the name in error messages.
Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings = {});

/// The beginning of a table.
struct CsvHead {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< unparsed cells
  char delimiter = ',';
};

/// Finds the header as read_csv_text() does and reads up to `most_rows` rows. Errors: no header.
Result<CsvHead> csv_head(std::string_view bytes, const std::string& file,
                         std::span<const CsvColumn> columns,
                         std::span<const ColumnMapping> mappings, std::size_t most_rows);

/// File name without its directory. Findings use it so that their bytes do not depend on the file's
/// location; errors show the path as typed.
std::string finding_file(const CsvTable& table);

}  // namespace awmr
