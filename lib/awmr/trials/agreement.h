/// Contradiction check for a quantity that a row gives twice. Private to this folder.
///
/// A trial row may contain both a printed value (a speed) and a timed one (distance over elapsed
/// time). The two agree if
///
///     |printed - timed| <= rounding(printed) + timed (stop_watch/elapsed + course)
///
/// with
///
///     rounding     half a unit in the last decimal place of the printed column, and at most 5 % of
///                  the value. Trailing zeros are lost, so the finest place in the whole column is
///                  used. Without the limit of 5 %, a column of whole numbers would agree with any
///                  value.
///     stop_watch   0.2 s: a hand on a stop watch is accurate to about 0.1 s, once at the start and
///                  once at the end. Times given to the millisecond or finer are not hand-timed:
///                  for them it is one unit of their last place.
///     course       0.5 %: uncertain ends of a 10 m course (5 cm) or of a full turn (2 deg).
#pragma once

#include <span>
#include <string_view>

#include "awmr/core/csv.h"

namespace awmr {

/// One unit in the last decimal place of a column as the file writes it, in the column's own unit.
/// `mappings` are those with which the table was read; a formula uses its computed values.
double last_place(const CsvTable& table, std::string_view column,
                  std::span<const ColumnMapping> mappings);

/// Maximum error of a printed value whose column has this last place.
double rounding_error(double printed, double last_place);

/// Maximum error of `timed`, which was measured over `elapsed_s` > 0.
double timing_error(double timed, double elapsed_s, double elapsed_last_place);

/// Standard deviation of a time written to this last place, s. For a stop watch that of two
/// presses, 0.1/sqrt(2) s each; for automatic timing that of the rounding.
double timing_std_s(double elapsed_last_place);

}  // namespace awmr
