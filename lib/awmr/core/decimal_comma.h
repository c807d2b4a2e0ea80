/// Detects numbers with decimal commas from all cells of a file, if the delimiter is not a comma.
/// Private to the library.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "awmr/core/csv_scanner.h"

namespace awmr {

/// Cells seen so far. A file must use one notation; "1,250" alone can mean 1250 or 1.25.
struct DecimalCommas {
  std::optional<CsvCell> comma = {};  ///< the first cell with a comma
  std::optional<CsvCell> point = {};  ///< the first number with a point
  bool unmistakable = false;          ///< some cell cannot have a thousands separator
};

/// Parses a cell like `-1,25` or `1,25e3` and records it in `seen`; nothing for any other text.
std::optional<double> number_with_comma(const CsvCell& cell, DecimalCommas& seen);

/// Records a number with a decimal point.
void note_point(const CsvCell& cell, DecimalCommas& seen);

/// Fault of the file's commas: points occur as well, or all commas can be thousands separators.
std::optional<std::string> fault_of(const DecimalCommas& seen);

}  // namespace awmr
