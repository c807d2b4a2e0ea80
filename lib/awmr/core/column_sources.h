/// Which columns of a header give those that are asked for. Private to the library.
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

/// Where one column that was asked for comes from.
struct ColumnSource {
  CsvColumn column;
  std::vector<std::size_t> indices;              ///< into the header; none for a constant
  const ColumnMapping* mapping = nullptr;        ///< null: the header's own
  std::optional<ColumnExpression> expression{};  ///< none: the one column, scaled
  double scale = 1.0;
  double offset = 0.0;
  std::optional<TimeColumn> time = {};  ///< where t_s was found by its unit or as dates
};

/// What is wrong with a header.
struct HeaderFault {
  std::optional<std::size_t> cell;  ///< none: the header as a whole
  std::string message;
};

struct ColumnSources {
  std::vector<ColumnSource> found = {};
  std::vector<HeaderFault> faults = {};
};

/// A mapping counts where the header has its columns, the file's own before those for every file
/// before the vehicle's; else the column is looked for under its own name. `file` is the table's
/// path, `samples` the cells of its first row, by which dates are known. Where t_s is neither there
/// nor mapped, it is looked for by find_time(). Faults: a required column is missing; two mappings
/// of one column; a formula of whose columns only some are there; a column that stands twice; more
/// than one column that may be the time.
ColumnSources find_columns(std::span<const std::string> header,
                           std::span<const std::string> samples, std::span<const CsvColumn> columns,
                           std::span<const ColumnMapping> mappings, const std::string& file);

/// The columns that a mapping is made from and that the header does not have; of several ways to
/// read the mapping, of that which find_columns() takes. Empty: the header has all of them.
std::vector<std::string> missing_columns(const ColumnMapping& mapping,
                                         std::span<const std::string> header);

/// The mapping is for every file, or for this one, by its path or its name.
bool is_for(const ColumnMapping& mapping, const std::string& file);

/// Every name that the columns and their mappings may look for in a header.
std::set<std::string> wanted_names(std::span<const CsvColumn> columns,
                                   std::span<const ColumnMapping> mappings);

}  // namespace awmr
