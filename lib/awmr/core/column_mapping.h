/// Maps a column to a file that has it under another name, in another unit, or as arithmetic over
/// several columns.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// Column `name` is the file's `source` times `scale` plus `offset`, or the value of `expression`.
/// The header decides: text equal to a column's name means that column; else `source` if the header
/// has it; else arithmetic over the header's columns.
struct ColumnMapping {
  std::string name;
  std::string source;  ///< empty: only the expression is used
  double scale = 1.0;
  double offset = 0.0;
  std::string expression =
      {};                 ///< text after the '='; empty: only source, scale and offset are used
  std::string file = {};  ///< applies only to the file of this name or path; empty: to every file
  bool standing = false;  ///< from the vehicle file: lowest priority, and may be unused
};

/// Parses `NAME=SOURCE[*SCALE][+OFFSET]`. A SOURCE may be quoted, and must be if it contains '*' or
/// '+'. After a scale or a quoted SOURCE, `-OFFSET` is also accepted. Errors: not of that form; a
/// scale or offset that is not a finite number; a scale of 0.
Result<ColumnMapping> parse_column_mapping(std::string_view text);

/// Parses `[FILE:]NAME=EXPRESSION`: the form above, arithmetic over columns (column_expression.h)
/// or a constant. Errors: neither of them; a scale of 0.
Result<ColumnMapping> parse_column(std::string_view text);
/// As above, with `[FILE:]NAME` and EXPRESSION separate, as in JSON.
Result<ColumnMapping> parse_column(std::string_view name, std::string_view expression);

/// The mapping as given, `NAME=EXPRESSION`: recorded as an option in outputs.
std::string text_of(const ColumnMapping& mapping);

/// `"SOURCE"*FACTOR+OFFSET` or `(EXPRESSION)*FACTOR+OFFSET`: an EXPRESSION whose values are those
/// of `mapping` (its scale and offset included) times `factor` plus `offset`. An offset of 0 is
/// omitted.
std::string scaled_expression(const ColumnMapping& mapping, double factor, double offset = 0.0);

}  // namespace awmr
