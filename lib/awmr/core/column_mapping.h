/// Mapping of one of awmr's columns to the columns of a file: to a column with another name or
/// unit, or to a formula over several columns.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// Defines column `name`. The header of the file decides which of these definitions is used; the
/// first possible one is taken:
///   1. `expression` is exactly the name of a column: that column;
///   2. the header has `source`: that column times `scale` plus `offset`;
///   3. `expression` is a formula over columns of the header.
struct ColumnMapping {
  std::string name;
  std::string source;  ///< empty: way 2 does not apply
  double scale = 1.0;
  double offset = 0.0;
  std::string expression = {};  ///< text after the '='; empty: only way 2 applies
  std::string file = {};        ///< name or path of the only file to apply it to; empty: all
  bool standing = false;        ///< true for mappings of vehicle.json: they have the lowest
                                ///< priority and may be unused
};

/// Parses `[FILE:]NAME=EXPRESSION`, where EXPRESSION is `SOURCE[*SCALE][+OFFSET]`, a formula
/// (column_expression.h) or a constant. A SOURCE that contains '*' or '+' must be in double quotes.
/// After a scale or a quoted SOURCE, `-OFFSET` is also accepted. Errors: a text that is none of
/// these; a scale of 0.
Result<ColumnMapping> parse_column(std::string_view text);
/// The same, with `[FILE:]NAME` and EXPRESSION as separate texts, as in JSON.
Result<ColumnMapping> parse_column(std::string_view name, std::string_view expression);

/// The mapping as text, `[FILE:]NAME=EXPRESSION`, as output files record it among the options of
/// the command (Provenance::options).
std::string text_of(const ColumnMapping& mapping);

/// Returns an EXPRESSION whose value is that of `mapping` (including its scale and offset) times
/// `factor` plus `offset`: `"SOURCE"*FACTOR+OFFSET` or `(EXPRESSION)*FACTOR+OFFSET`.
std::string scaled_expression(const ColumnMapping& mapping, double factor, double offset = 0.0);

}  // namespace awmr
