/// Recognises decimal commas in files whose delimiter is not a comma. Private to the library.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "awmr/core/csv/csv_scanner.h"

namespace awmr {

/// Commas and points in the cells of a file, which together show what a comma means: "1,250" can be
/// 1250 or 1.25. All numbers of a file must use the same decimal mark.
struct DecimalCommas {
  std::optional<CsvCell> comma = {};  ///< the first number with a comma
  std::optional<CsvCell> point = {};  ///< the first number with a point
  /// True if at least one comma cannot be a thousands separator, so that all commas are decimal.
  bool unmistakable = false;
};

/// Parses a cell such as `-1,25` or `1,25e3` and records its comma in `seen`. Empty for other text.
std::optional<double> number_with_comma(const CsvCell& cell, DecimalCommas& seen);

/// Records in `seen` that the number in this cell has a decimal point. No effect if it has none.
void note_point(const CsvCell& cell, DecimalCommas& seen);

/// Message for a fault: some numbers of the file have a decimal comma and some a decimal point, or
/// each comma may as well be a thousands separator. Empty if there is no fault.
std::optional<std::string> fault_of(const DecimalCommas& seen);

}  // namespace awmr
