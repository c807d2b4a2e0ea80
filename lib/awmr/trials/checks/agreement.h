/// Tolerance for comparing two values of the same quantity in a table row. Private to trials/.
/// The printed value is a number in the file, such as a speed. The timed value is distance over
/// elapsed time. The two values agree if
///
///     |printed - timed| <= rounding(printed) + timed (stop_watch/elapsed + course)
///
/// with
///
///     rounding     half a unit in the last decimal place of the printed column, at most 5 % of the
///                  value. The last place is the finest one in the column, because trailing zeros
///                  are lost. Without the limit of 5 %, small whole numbers would agree with almost
///                  any value.
///     stop_watch   0.2 s: 0.1 s for pressing the stop watch at the start, 0.1 s at the end. For
///                  times given to the millisecond or finer, which were taken automatically: one
///                  unit of their last place.
///     course       0.5 %: a track of 10 m is measured to 5 cm, a full turn to 2 deg.
#pragma once

#include <span>
#include <string_view>

#include "awmr/core/csv.h"

namespace awmr {

/// Returns the value of one unit in the last decimal place of a column, in awmr's unit of the
/// column: 0.01 for speeds such as 1.25 m/s. If a formula computes the column, uses the computed
/// values. `mappings`: column mappings used to read the table.
double last_place(const CsvTable& table, std::string_view column,
                  std::span<const ColumnMapping> mappings);

/// Maximum rounding error of a printed value. `last_place`: result of last_place() for its column.
double rounding_error(double printed, double last_place);

/// Largest plausible error of `timed`, a speed or yaw rate computed as distance or angle over the
/// time `elapsed_s` > 0. It includes the error of the time and 0.5 % for the distance or angle.
/// `elapsed_last_place`: last_place() of the times, s.
double timing_error(double timed, double elapsed_s, double elapsed_last_place);

/// Standard deviation of the error of a time, s: 0.1 s for a stop watch, from two presses of
/// 0.1/sqrt(2) s each; elapsed_last_place/sqrt(12) for automatic times. `elapsed_last_place`:
/// last_place() of the times, s.
double timing_std_s(double elapsed_last_place);

}  // namespace awmr
