/// When two values of one quantity in a row contradict each other. Private to this folder.
///
/// A trial row may give a quantity twice: as printed (a speed) and through what was timed (distance
/// over elapsed time). The two agree where
///
///     |printed - timed| <= rounding(printed) + timed (stop_watch/elapsed + course)
///
/// with
///
///     rounding     half a unit in the last decimal place of the printed column, and at most 5 % of
///                  the value. Trailing zeros are not seen, so the place is the finest of the whole
///                  column; the 5 % keep a column of whole numbers from agreeing with everything.
///     stop_watch   0.2 s: a hand on a stop watch is good to about 0.1 s, once at the start and
///                  once at the end. Times given to the millisecond or finer are not hand-timed:
///                  for them it is one unit of their last place.
///     course       0.5 %: where a 10 m course (to 5 cm) or a full turn (to 2 deg) begins and ends.
#pragma once

#include <span>
#include <string_view>

#include "awmr/core/csv.h"

namespace awmr {

/// One unit in the last decimal place of a column as the file writes it, in the column's own unit.
/// `mappings` are those that the table was read with; a formula counts by its own values.
double last_place(const CsvTable& table, std::string_view column,
                  std::span<const ColumnMapping> mappings);

/// How far the truth may lie from a printed value whose column has this last place.
double rounding_error(double printed, double last_place);

/// How far the truth may lie from `timed`, which was measured over `elapsed_s` > 0.
double timing_error(double timed, double elapsed_s, double elapsed_last_place);

/// Standard deviation of a time written to this last place, s: that of a stop watch's two presses,
/// 0.1/sqrt(2) s each, or of the rounding of an automatic one.
double timing_std_s(double elapsed_last_place);

}  // namespace awmr
