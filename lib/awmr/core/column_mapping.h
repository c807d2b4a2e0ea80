/// Where a column comes from when the file calls it otherwise: another name, another unit, or
/// arithmetic over several columns.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// Column `name` is the file's `source` times `scale` plus `offset`, or what `expression` says. The
/// header decides: a text that equals a column's name is that column; else a `source` that the
/// header has; else arithmetic over its columns.
struct ColumnMapping {
  std::string name;
  std::string source;  ///< empty: the expression alone
  double scale = 1.0;
  double offset = 0.0;
  std::string expression =
      {};                 ///< what stood behind the '='; empty: source, scale and offset alone
  std::string file = {};  ///< only for the file of this name or path; empty: for every file
  bool standing = false;  ///< the vehicle's: behind all others, and it may be unused
};

/// `NAME=SOURCE[*SCALE][+OFFSET]`. A SOURCE may be quoted, and must be where it holds '*' or '+';
/// after a scale or a quoted SOURCE, `-OFFSET` is taken as well. Errors: not of that form, a scale
/// or offset that is no finite number, a scale of 0.
Result<ColumnMapping> parse_column_mapping(std::string_view text);

/// `[FILE:]NAME=EXPRESSION`: the form above, arithmetic over columns (column_expression.h) or a
/// constant. Errors: neither of them, a scale of 0.
Result<ColumnMapping> parse_column(std::string_view text);
/// The same with `[FILE:]NAME` and EXPRESSION apart, as JSON has them.
Result<ColumnMapping> parse_column(std::string_view name, std::string_view expression);

/// The mapping as it was given, `NAME=EXPRESSION`: what an output names as its option.
std::string text_of(const ColumnMapping& mapping);

/// `"SOURCE"*FACTOR+OFFSET` or `(EXPRESSION)*FACTOR+OFFSET`: the EXPRESSION of a mapping whose values are
/// those of this one, its own scale and offset included, times `factor`, plus `offset`. No offset of 0.
std::string scaled_expression(const ColumnMapping& mapping, double factor, double offset = 0.0);

}  // namespace awmr
