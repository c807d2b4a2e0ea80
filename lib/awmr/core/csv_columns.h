/// The columns of a CSV file that are read, and what a cell of one comes to. Private to the library.
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
  std::string name;          ///< as errors call it
  bool may_be_empty = true;  ///< for all that is made from it
  bool is_date = false;      ///< a date of ISO 8601
};

/// Each column once, however many are made from it.
std::vector<CsvUsedColumn> used_columns(const ColumnSources& sources,
                                        std::span<const std::string> header);

/// The value of a cell without quotes, whose outer spaces may stand; kEmptyCell where it is empty and
/// may be. Nothing where it is wrong.
std::optional<double> csv_value(std::string_view text, const CsvUsedColumn& column);

}  // namespace awmr
