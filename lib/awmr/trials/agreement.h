/// Tolerance for a quantity that a table row gives twice: as a printed value (a speed) and as a
/// timed one (distance over elapsed time). Private to this folder. The two values agree if
///
///     |printed - timed| <= rounding(printed) + timed (stop_watch/elapsed + course)
///
/// with
///
///     rounding     half a unit in the last decimal place of the printed column, at most 5 % of the
///                  value. The last place is the finest one in the column, because trailing zeros
///                  are lost. Without the limit of 5 %, small whole numbers would agree with almost
///                  any value.
///     stop_watch   0.2 s: 0.1 s for pressing the stop watch at the start, 0.1 s at the end. Times
///                  given to the millisecond or finer are timed automatically: one unit of their
///                  last place.
///     course       0.5 %: the ends of a 10 m course are known to 5 cm, those of a turn to 2 deg.
#pragma once

#include <span>
#include <string_view>

#include "awmr/core/csv.h"

namespace awmr {

/// Returns one unit in the last decimal place of a column as written in the file, converted to
/// awmr's unit of the column. For a column computed by a formula: the last place of its computed
/// values. `mappings`: column mappings with which the table was read.
double last_place(const CsvTable& table, std::string_view column,
                  std::span<const ColumnMapping> mappings);

/// Maximum rounding error of a printed value whose column has this last place.
double rounding_error(double printed, double last_place);

/// Largest plausible error of `timed`, a speed or yaw rate computed as distance or angle over the
/// time `elapsed_s` > 0. It allows for the error of the time, and for a fixed relative error of the
/// distance. `elapsed_last_place`: last_place() of the times, s.
double timing_error(double timed, double elapsed_s, double elapsed_last_place);

/// Standard deviation, s, of a time whose column has this last place, s. Above 1 ms (stop watch):
/// 0.1 s, from two presses of 0.1/sqrt(2) s each. Else (automatic timing): that of the rounding,
/// last place/sqrt(12).
double timing_std_s(double elapsed_last_place);

}  // namespace awmr
