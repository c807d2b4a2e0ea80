/// CSV that is in memory already.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "awmr/core/csv.h"

namespace awmr {

/// As read_csv, from a text; `file` names it in errors.
Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings = {});

/// The file's name without its directory, for findings, whose bytes are the same wherever the file
/// lies; errors show the path as typed.
std::string finding_file(const CsvTable& table);

}  // namespace awmr
