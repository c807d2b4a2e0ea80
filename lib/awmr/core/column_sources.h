/// Finds the columns of a header that provide the requested columns. Private to the library.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/column_expression.h"
#include "awmr/core/csv.h"
#include "awmr/core/time_column.h"

namespace awmr {

/// Source of one requested column.
struct ColumnSource {
  CsvColumn column;
  std::vector<std::size_t> indices;              ///< into the header; none for a constant
  const ColumnMapping* mapping = nullptr;        ///< null: the header's own
  std::optional<ColumnExpression> expression{};  ///< none: the one column, scaled
  double scale = 1.0;
  double offset = 0.0;
  std::optional<TimeColumn> time = {};  ///< set if t_s was found by its unit or as dates
};

/// A fault of a header.
struct HeaderFault {
  ErrorCode code;
  std::optional<std::size_t> cell;  ///< none: the header as a whole
  std::string message;
};

struct ColumnSources {
  std::vector<ColumnSource> found = {};
  std::vector<HeaderFault> faults = {};
};

/// A mapping applies if the header has its columns. Order of priority: mappings of this file,
/// mappings of every file, mappings of the vehicle, then the column under its own name. `file` is
/// the table's path. `samples` are the cells of its first row, used to recognise dates. If t_s is
/// neither present nor mapped, find_time() looks for it.
/// Faults: a missing required column; two mappings of one column; a formula with only some of its
/// columns present; a column name that occurs twice; more than one candidate for the time.
ColumnSources find_columns(std::span<const std::string> header,
                           std::span<const std::string> samples, std::span<const CsvColumn> columns,
                           std::span<const ColumnMapping> mappings, const std::string& file);

/// Columns that the mapping needs and the header does not have, for the reading of the mapping that
/// find_columns() chooses. Empty: the header has all of them.
std::vector<std::string> missing_columns(const ColumnMapping& mapping,
                                         std::span<const std::string> header);

/// True if the mapping applies to every file, or to this one by its path or name.
bool is_for(const ColumnMapping& mapping, const std::string& file);

/// All names that the columns and their mappings can refer to in a header.
std::set<std::string> wanted_names(std::span<const CsvColumn> columns,
                                   std::span<const ColumnMapping> mappings);

}  // namespace awmr
