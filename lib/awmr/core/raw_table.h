/// The numbers of a file before names and units are applied: the common form of all formats, from
/// which the table of requested columns is made. Private to the library.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv.h"

namespace awmr {

/// Marks a cell without a value, or with a fault already reported. It cannot be read from a file,
/// because values in files are finite.
inline constexpr double kEmptyCell = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kFaultyCell = std::numeric_limits<double>::infinity();

struct RawColumn {
  std::vector<double> value = {};
  std::vector<int> character = {};  ///< position in the line, from 1; empty: unknown
};

struct RawTable {
  std::string file;
  int header_line = 1;
  RowLines lines = {};
  std::vector<RawColumn> columns = {};  ///< as in the header; unused ones are empty
  std::vector<CsvNote> notes = {};
  std::vector<std::size_t> mapped = {};  ///< mappings used to read it
  bool joined = false;  ///< made of signals with different sample times: cells can be empty
};

/// Makes the requested columns. `faults`: those found so far; `mappings`: those used to find
/// `sources`. Errors: as read_csv().
Result<CsvTable> table_of(RawTable raw, ColumnSources sources,
                          std::span<const ColumnMapping> mappings, std::vector<Fault> faults);

}  // namespace awmr
