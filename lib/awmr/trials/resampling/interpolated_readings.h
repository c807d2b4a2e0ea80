/// Recovers the readings of columns that a program interpolated linearly between slower readings
/// (np.interp, pandas, MATLAB interp1). Private to trials/.
///
/// Interpolated values lie on a chain of straight lines, and the readings are the corners of this
/// chain. (Noise of the sensor does not hide the lines, because it was interpolated, too.) Row i is
/// on a line if its distance from the chord through its neighbours,
///
///     e_i = x_i - (x_(i-1) (t_(i+1) - t_i) + x_(i+1) (t_i - t_(i-1)))/(t_(i+1) - t_(i-1))
///
/// is at most a tolerance: 2 % of the 75 % quantile of |e|, or the rounding of the file (of values,
/// and of times to 1 us) if this is larger. Between two lines of two or more rows, a corner is
/// their intersection.
#pragma once

#include <optional>
#include <span>

#include "line_chain.h"

namespace awmr {

/// Returns the readings of a column at the ascending times `t_s`, or nothing if it is not
/// interpolated. Criteria for interpolation:
///   - the rows on lines exceed the number expected from the rows near the tolerance by at least
///     10 % of all rows;
///   - rows on lines are typically off by at most the rounding or 1 % of the tolerance, other
///     rows by at least three tolerances;
///   - at least 80 % of the time spans between corners are about equal; their median is 1.9 to 20
///     rows;
///   - at least 95 % of the rows are on the lines between the readings, which cover at least 80 %
///     of the time.
///
/// These tests are made with all rows, and if they fail, with every second or every fourth row.
/// `rounding`: smallest_step() of the column.
std::optional<Readings> interpolated_readings(std::span<const double> t_s,
                                              std::span<const double> value, double rounding);

/// Returns the readings of a column at the times `readings_s`, at which another column had
/// readings, or nothing if this column was not interpolated between these times, or has fewer
/// readings.
std::optional<Readings> interpolated_between(std::span<const double> readings_s,
                                             std::span<const double> t_s,
                                             std::span<const double> value, double rounding);

/// Returns the values at the times `readings_s` of a command that changes only in the first row
/// after such a time: a program held each value of the slower log until the next. Nothing for other
/// commands, and for fewer than 10 changes.
std::optional<Readings> changing_at(std::span<const double> readings_s, std::span<const double> t_s,
                                    std::span<const double> value);

/// Smallest difference, above 0, between two values of a column, or between two successive changes
/// (for a column that only rises). 0 if all values are equal. For rounded values, this is the
/// resolution of the file, in the unit of `value`.
double smallest_step(std::span<const double> value);

/// Largest power of ten, 1 to 1e-9, of which all values are multiples: the last decimal place of
/// the numbers in a file. 0 if there is none. For columns with few different values.
double printed_resolution(std::span<const double> value);

}  // namespace awmr
