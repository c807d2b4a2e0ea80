/// CSV that is open or in memory already.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/input_bytes.h"

namespace awmr {

/// UTF-8's, which some programs put at the beginning of a file.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// As read_csv, of an input that is open.
Result<CsvTable> read_csv(std::shared_ptr<const InputBytes> bytes,
                          std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings = {});

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
