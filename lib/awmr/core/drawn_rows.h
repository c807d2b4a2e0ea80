/// Which rows of a time series a chart needs, and how many digits. Not installed.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// The rows, first and last among them, between which straight lines pass by every signal at every
/// row at a distance of at most `tolerance` times the signal's own range: peaks stay, whatever their
/// width. Where that takes more than `most` rows, the tolerance is doubled until it does not.
///
/// Douglas and Peucker's method, for all signals at once, along time.
/// t: ascending, one value a row; signals: each with as many values. `most` >= 2.
std::vector<std::size_t> drawn_rows(std::span<const double> t,
                                    std::span<const std::vector<double>> signals, double tolerance,
                                    std::size_t most);

/// Within 1/2000 of its range a signal is drawn as it is: a tenth of a pixel of a chart 220 px high, a
/// pixel when enlarged tenfold.
inline constexpr double kDrawnTolerance = 1.0 / 2000.0;

/// Five digits of a finite number.
double drawn_number(double x);

}  // namespace awmr
