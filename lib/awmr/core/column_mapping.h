/// Mapping that computes a column of awmr from the columns of a user's file: from a column with
/// another name or unit, or by a formula over several columns.
#pragma once

#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// How to compute the column `name`. The first of these definitions that the header of the file
/// permits is used:
///   1. if the header has a column called `expression`: this column;
///   2. if the header has a column called `source`: this column times `scale` plus `offset`;
///   3. else the formula `expression` over columns of the header.
struct ColumnMapping {
  std::string name;
  std::string source;  ///< name of a column; empty: definition 2 does not apply
  double scale = 1.0;
  double offset = 0.0;
  std::string expression = {};  ///< text after the '='; empty: only definition 2 can apply
  std::string file = {};        ///< name or path of the file that it is for; empty: all files
  /// True for a mapping from vehicle.json. It has the lowest priority. Not using it is no fault.
  bool standing = false;
};

/// Parses `[FILE:]NAME=EXPRESSION`. EXPRESSION is a scaled column `SOURCE[*SCALE][+OFFSET]`, a
/// formula (column_expression.h) or a constant. SOURCE, the name of a column, must be in double
/// quotes if it contains '*' or '+'. After a scale or a quoted SOURCE, `-OFFSET` is also accepted.
/// Errors: any other text; a scale of 0.
Result<ColumnMapping> parse_column(std::string_view text);
/// As parse_column(text), for `[FILE:]NAME` and EXPRESSION as separate texts, as in JSON files.
Result<ColumnMapping> parse_column(std::string_view name, std::string_view expression);

/// Writes a mapping as `[FILE:]NAME=EXPRESSION`, the form that parse_column() reads. Output files
/// record the mappings in this form (Provenance::options).
std::string text_of(const ColumnMapping& mapping);

/// Returns an EXPRESSION (see parse_column()) for the column that `mapping` defines, multiplied by
/// `factor` and increased by `offset`. It has the form `"SOURCE"*FACTOR+OFFSET` or
/// `(FORMULA)*FACTOR+OFFSET`, and includes the scale and offset of `mapping`.
std::string scaled_expression(const ColumnMapping& mapping, double factor, double offset = 0.0);

}  // namespace awmr
