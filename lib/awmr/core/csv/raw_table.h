/// The numbers of a file, in the form that the readers of all file formats (CSV, ROS bags, ...)
/// return, and their conversion to the table of requested columns. Private to the library.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/csv/column_sources.h"

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

/// For a log with signals of different rates: drops the rows that a fit cannot use. These are the
/// rows in which every column that may have empty cells is empty (columns other than
/// EmptyCells::kFault, csv.h), and all rows at the beginning of the log until each command (kHeld)
/// has had its first value. Adds the note `joined-by-time` with the numbers of rows kept and
/// dropped.
void drop_rows(CsvTable& table, const ColumnSources& sources);

/// True for a column that has no value in any row.
bool is_void(const CsvTable::Column& column);
/// Adds a fault for each requested column that is empty in all rows, except for columns that may be
/// absent (EmptyCells::kOptional).
void refuse_void_columns(const CsvTable& table, const ColumnSources& sources,
                         std::vector<Fault>& faults);

}  // namespace awmr
