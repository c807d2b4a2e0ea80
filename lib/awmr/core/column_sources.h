/// Finds the columns of a file from which each requested column is computed. Private to the
/// library.
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

/// Source of a requested column: how it is computed from the columns of the file.
struct ColumnSource {
  CsvColumn column;                              ///< the requested column
  std::vector<std::size_t> indices;              ///< columns of the header from which it is made
  const ColumnMapping* mapping = nullptr;        ///< null: a column of this name, or `time`
  std::optional<ColumnExpression> expression{};  ///< none: column * scale + offset
  double scale = 1.0;
  double offset = 0.0;
  std::optional<TimeColumn> time = {};  ///< set for t_s from find_time() or from dates
};

/// A fault of the header.
struct HeaderFault {
  ErrorCode code;
  std::optional<std::size_t> cell;  ///< index of the faulty cell; none: the whole header
  std::string message;
};

struct ColumnSources {
  std::vector<ColumnSource> found = {};
  std::vector<HeaderFault> faults = {};
};

/// Finds the source of each requested column. A mapping applies if the header has its columns.
/// Priority: mappings for this file, mappings for every file, mappings of vehicle.json, then the
/// column of the requested name. If t_s is neither present nor mapped, find_time() looks for it.
/// `samples`: the cells of the first row, by which dates are recognised. `file`: path of the table.
/// Faults: a missing required column; two mappings of one column; a formula for which the header
/// lacks some of its columns; a name that occurs twice in the header; several candidates for the
/// time.
ColumnSources find_columns(std::span<const std::string> header,
                           std::span<const std::string> samples, std::span<const CsvColumn> columns,
                           std::span<const ColumnMapping> mappings, const std::string& file);

/// Columns that the mapping needs and the header lacks; empty if the mapping applies to this
/// header.
std::vector<std::string> missing_columns(const ColumnMapping& mapping,
                                         std::span<const std::string> header);

/// True if the mapping is for every file, or names this file by its path or name.
bool is_for(const ColumnMapping& mapping, const std::string& file);

/// Column names that distinguish a header from other lines: the names of these columns, and the
/// names in the mappings.
std::set<std::string> wanted_names(std::span<const CsvColumn> columns,
                                   std::span<const ColumnMapping> mappings);

}  // namespace awmr
