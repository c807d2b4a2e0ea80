/// The numbers of a file, in the form that the readers of all file formats (CSV, ROS bags, ...)
/// return, and their conversion to the table of requested columns. Private to the library.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv.h"

namespace awmr {

/// Markers for a cell without a value, and for a cell whose fault was already reported. Numbers
/// from files are finite, so they never equal a marker.
inline constexpr double kEmptyCell = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kFaultyCell = std::numeric_limits<double>::infinity();

struct RawColumn {
  std::vector<double> value = {};
  std::vector<int> character = {};  ///< by row: position in the line, from 1; empty: unknown
};

struct RawTable {
  std::string file;
  int header_line = 1;
  RowLines lines = {};
  std::vector<RawColumn> columns = {};  ///< by column of the header; unused columns are empty
  std::vector<CsvNote> notes = {};
  std::vector<std::size_t> mapped = {};  ///< indices of the mappings used so far
  bool joined = false;                   ///< true: signals of different rates; cells may be empty
};

/// Converts the table to the requested columns. `sources`: the result of find_columns() with
/// `mappings`. `faults`: faults found so far, which are reported together with the new ones.
/// Errors: as read_csv().
Result<CsvTable> table_of(RawTable raw, ColumnSources sources,
                          std::span<const ColumnMapping> mappings, std::vector<Fault> faults);

}  // namespace awmr
