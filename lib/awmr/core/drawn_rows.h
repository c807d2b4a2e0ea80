/// Selects the rows of a time series that a chart needs, and rounds its numbers. Not installed.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// Rows, first and last included, whose connecting straight lines stay within `tolerance` times
/// each signal's range at every row. Peaks are kept, whatever their width. If more than `most` rows
/// are necessary, the tolerance is doubled until they suffice.
///
/// Douglas-Peucker along time, for all signals together.
/// t: ascending, one value a row; signals: each with as many values. `most` >= 2.
std::vector<std::size_t> drawn_rows(std::span<const double> t,
                                    std::span<const std::vector<double>> signals, double tolerance,
                                    std::size_t most);

/// Tolerance as a fraction of a signal's range: a tenth of a pixel in a chart 220 px high, one
/// pixel at tenfold zoom.
inline constexpr double kDrawnTolerance = 1.0 / 2000.0;

/// Rounds a finite number to this many significant digits, 1 to 17.
double rounded_number(double x, int digits);

/// Rounds a finite number to the five digits that a chart shows.
double drawn_number(double x);

}  // namespace awmr
