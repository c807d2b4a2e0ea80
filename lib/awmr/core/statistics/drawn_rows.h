/// Reduces a time series to the rows that its chart needs, and rounds numbers for charts. Not
/// installed.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// Selects rows for a line chart: the straight lines between them deviate from each signal by at
/// most `tolerance` times the signal's range (Douglas-Peucker algorithm over time, for all signals
/// together). The first and the last row are always selected. If more than `most` >= 2 rows result,
/// the tolerance is doubled until they suffice. `t`: times, ascending, one per row. Each signal has
/// one value per row.
std::vector<std::size_t> drawn_rows(std::span<const double> t,
                                    std::span<const std::vector<double>> signals, double tolerance,
                                    std::size_t most);

/// Tolerance for drawn_rows(), as a fraction of a signal's range: a tenth of a pixel in a chart 220
/// px high, so one pixel at tenfold zoom. A larger value gives smaller files and visible errors.
inline constexpr double kDrawnTolerance = 1.0 / 2000.0;

/// Rounds a finite number to this many significant digits, 1 to 17.
double rounded_number(double x, int digits);

/// Rounds a finite number to five significant digits, for charts.
double drawn_number(double x);

}  // namespace awmr
