/// The columns of a CSV file that are read, and the conversion of their cells. Private to the
/// library.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/column_sources.h"

namespace awmr {

/// A column of the file that is read.
struct CsvUsedColumn {
  std::size_t index;         ///< into the header
  std::string name;          ///< name in error messages
  bool may_be_empty = true;  ///< for every column derived from it
  bool is_date = false;      ///< a date of ISO 8601
};

/// Each file column once, however many requested columns use it.
std::vector<CsvUsedColumn> used_columns(const ColumnSources& sources,
                                        std::span<const std::string> header);

/// Value of an unquoted cell; surrounding spaces are allowed. kEmptyCell if it is empty and may be.
/// Nothing if it is invalid.
std::optional<double> csv_value(std::string_view text, const CsvUsedColumn& column);

}  // namespace awmr
