/// The numbers of a file as they stand in it, before names and units: what every format is read
/// into, and what the table of the columns asked for is made from. Private to the library.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv.h"

namespace awmr {

/// Stands for a cell without a value, and for one whose fault is known already. Neither can be read
/// from a file: values are finite.
inline constexpr double kEmptyCell = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kFaultyCell = std::numeric_limits<double>::infinity();

struct RawColumn {
  std::vector<double> value = {};
  std::vector<int> character = {};  ///< place in the line, from 1; empty: not kept
};

struct RawTable {
  std::string file;
  int header_line = 1;
  RowLines lines = {};
  std::vector<RawColumn> columns = {};  ///< as in the header; those that are not wanted are empty
  std::vector<CsvNote> notes = {};
  std::vector<std::size_t> mapped = {};           ///< mappings that were used to read it
  std::shared_ptr<const CellPlaces> places = {};  ///< where they are not kept but can be found
  bool may_have_empty = true;                     ///< false: every cell has a value
  bool joined = false;  ///< made of signals with times of their own: cells may be empty
};

/// The columns that were asked for. `faults` are those found so far; `mappings` those that `sources`
/// were found with. Errors: as read_csv().
Result<CsvTable> table_of(RawTable raw, ColumnSources sources,
                          std::span<const ColumnMapping> mappings, std::vector<Fault> faults);

}  // namespace awmr
