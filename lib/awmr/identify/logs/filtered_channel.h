/// Simulation of a sensor's first-order low-pass filter, with derivatives. Private to identify/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/identify/logs/command_path.h"

namespace awmr {

/// The filter of a sensor.
struct SensorFilter {
  DelayColumn lag;  ///< time constant T, s
  bool is_at_rows;  ///< true: one step for each row of the log; false: continuous
};

/// Output y of a filter with the input u and the time constant T, and its derivatives by the
/// columns of the fit (linear_stepper.h). With rows h apart and e = exp(-h/T),
///
///     y(t + h) = u(t + h) - q (u(t + h) - u(t)) + e (y(t) - u(t))
///     q = (T/h)(1 - e)   continuous, T dy/dt = u - y, u linear between rows
///     q = e              at the rows, y(t + h) = e y(t) + (1 - e) u(t + h)
///
/// y starts at the first reading of the window. The effect of that reading's noise decays with the
/// time constant T.
class FilteredChannel {
 public:
  /// `first`: first reading of the window, the initial y. `columns`: number of columns of the fit,
  /// by which y is differentiated; 0: only y is computed.
  FilteredChannel(const SensorFilter& filter, double first, std::size_t columns)
      : filter_(filter), y_(first), by_column_(columns, 0.0) {}

  /// Advances the filter by h_s seconds to the input u. `by`: derivatives of u, one per column.
  void next(double u, const double* by, double h_s, std::size_t columns);
  double value() const { return y_; }
  const std::vector<double>& by_column() const { return by_column_; }

 private:
  void move(double u, const double* by, double h_s, std::size_t columns);

  SensorFilter filter_;
  double y_;
  double u_before_ = 0.0;
  bool has_before_ = false;
  std::vector<double> by_column_;
  std::vector<double> by_before_;
};

}  // namespace awmr
