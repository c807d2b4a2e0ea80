/// Reads CSV from text in memory.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"

namespace awmr {

/// As read_csv(), but parses `bytes`, the content of a file. `file`: name of the file in errors.
Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings = {});

/// Header and first rows of a table, as text.
struct CsvHead {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< cells, by row
  char delimiter = ',';
};

/// Reads the header and up to `most_rows` rows as text. The header is recognised by the names in
/// `columns` and `mappings`; lines of titles above it are skipped. Errors: those of find_header()
/// (csv_header.h).
Result<CsvHead> csv_head(std::string_view bytes, const std::string& file,
                         std::span<const CsvColumn> columns,
                         std::span<const ColumnMapping> mappings, std::size_t most_rows);

/// Name of the table's file without its directory, for findings: so outputs do not depend on where
/// the file is.
std::string finding_file(const CsvTable& table);

}  // namespace awmr
