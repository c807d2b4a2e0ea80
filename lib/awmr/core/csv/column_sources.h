/// Finds the columns of a file from which each requested column is computed. Private to the
/// library.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/csv/column_expression.h"
#include "awmr/core/csv/time_column.h"

namespace awmr {

/// Source of a requested column: how it is computed from the columns of the file.
struct ColumnSource {
  CsvColumn column;                  ///< the requested column
  std::vector<std::size_t> indices;  ///< indices, in the header, of the columns used
  /// Mapping that gives the column. Null if no mapping is used: the header has a column of this
  /// name, or find_time() found the time.
  const ColumnMapping* mapping = nullptr;
  std::optional<ColumnExpression> expression{};  ///< none: column * scale + offset
  double scale = 1.0;
  double offset = 0.0;
  std::optional<TimeColumn> time = {};  ///< only for t_s: how its cells give the time
};

struct HeaderFault {
  ErrorCode code;
  std::optional<std::size_t> cell;  ///< index of the faulty cell; none: the whole header
  std::string message;
};

struct ColumnSources {
  std::vector<ColumnSource> found = {};
  std::vector<HeaderFault> faults = {};
};

/// Finds the source of each requested column. A mapping is usable if the header has all columns
/// that it names. Of several sources, the first in this order is used: a mapping for this file; a
/// mapping for every file; a mapping in vehicle.json; the column of the requested name. If there is
/// none for the time t_s, find_time() looks for a time column. `samples`: cells of the first row,
/// which show whether a column has dates. `file`: path of the table. Faults: a missing required
/// column; two mappings of one column; a formula for which the header lacks some columns; a name
/// that occurs twice in the header; several columns that may be the time.
ColumnSources find_columns(std::span<const std::string> header,
                           std::span<const std::string> samples, std::span<const CsvColumn> columns,
                           std::span<const ColumnMapping> mappings, const std::string& file);

/// Columns that the mapping needs and the header lacks; empty if none is missing.
std::vector<std::string> missing_columns(const ColumnMapping& mapping,
                                         std::span<const std::string> header);

/// True if the mapping is for every file, or names this file by its path or name.
bool is_for(const ColumnMapping& mapping, const std::string& file);

/// Column names by which a line is recognised as the header: the requested columns, and all names
/// in the mappings.
std::set<std::string> wanted_names(std::span<const CsvColumn> columns,
                                   std::span<const ColumnMapping> mappings);

}  // namespace awmr
