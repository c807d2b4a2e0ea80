/// Numbers with a decimal comma, where the cells are parted by something else: what all the cells of
/// a file show together. Private to the library.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "awmr/core/csv_scanner.h"

namespace awmr {

/// The cells that were seen. One way of writing for a whole file; "1,250" alone may be a thousand
/// and a quarter of it or one and a quarter.
struct DecimalCommas {
  std::optional<CsvCell> comma = {};  ///< the first cell with a comma
  std::optional<CsvCell> point = {};  ///< the first number with a point
  bool unmistakable = false;          ///< some cell cannot be a number of thousands
};

/// The number of a cell like `-1,25` or `1,25e3`, which is noted; nothing for any other text.
std::optional<double> number_with_comma(const CsvCell& cell, DecimalCommas& seen);

/// Notes a number with a point.
void note_point(const CsvCell& cell, DecimalCommas& seen);

/// What is wrong with the commas of the file: points as well, or only what may be thousands.
std::optional<std::string> fault_of(const DecimalCommas& seen);

}  // namespace awmr
