/// Columns whose rows lie on a chain of straight lines (interpolated_readings.h). Private to trials/.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// Readings at the times `t_s`, s, ascending.
struct Readings {
  std::vector<double> t_s;
  std::vector<double> value;

  void add(double at_s, double reading) {
    t_s.push_back(at_s);
    value.push_back(reading);
  }
};

/// A column, and how far its rows are off the chord through their neighbours.
struct LinedColumn {
  std::span<const double> t_s, value;
  std::vector<double> off_chord;  ///< |e_i| by row; 0 for the first and the last row
  std::vector<bool> is_flat;      ///< both neighbours have the same value
  double tolerance = 0.0;         ///< largest |e_i| of a row on a line
  double rounding = 0.0;          ///< resolution of the values; 0 if unknown

  std::size_t rows() const { return value.size(); }
  bool is_on_line(std::size_t row) const { return off_chord[row] <= tolerance; }
  /// |e_i| of the rows that are not flat.
  std::vector<double> deviations() const {
    std::vector<double> all;
    for (std::size_t i = 1; i + 1 < rows(); ++i) {
      if (!is_flat[i]) all.push_back(off_chord[i]);
    }
    return all;
  }
};

/// |e_i|: distance of row i from the chord through its neighbours. Not for the first and last row.
double off_chord(std::span<const double> t_s, std::span<const double> value, std::size_t row);

/// `rounding`: resolution of the values; 0 if unknown.
LinedColumn lined_column(std::span<const double> t_s, std::span<const double> value,
                         double rounding);

/// True if far more rows are on lines than chance explains.
bool has_lines(const LinedColumn& column);

/// Corners of the chain of lines, and the first and the last row.
Readings corners_of(const LinedColumn& column);

/// True if at least 80 % of the time spans between the corners are about equal, and their median is
/// 1.9 to 20 rows.
bool are_evenly_spaced(const LinedColumn& column, const Readings& corners);

/// Value at the time of a reading, on the lines through the two rows before and the two rows after
/// it, if these rows are within the neighbouring readings.
double value_at(const LinedColumn& column, double at_s, double previous_s, double next_s);

}  // namespace awmr
