/// Simulation of a sensor's low-pass filter. Private to identify/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/identify/logs/linear_replay.h"

namespace awmr {

/// Output y of a first-order filter with the time constant T, and its derivatives by column: T
/// dy/dt = u - y. With u linear between rows and e = exp(-h/T), q = (T/h)(1 - e),
///
///     y(t + h) = u(t + h) - q (u(t + h) - u(t)) + e (y(t) - u(t))
///
/// It starts at the first reading of the window, whose noise decays with the time constant.
class SmoothedChannel {
 public:
  /// `first`: the first reading. `columns`: 0 for values without derivatives.
  SmoothedChannel(LogChannel channel, const DelayColumn& lag, double first, std::size_t columns)
      : channel_(channel), lag_(lag), y_(first), by_column_(columns, 0.0) {}

  /// Advances to the motion `now`, h seconds after the previous one.
  void next(const LinearMotion& now, double h_s, std::size_t columns);
  double value() const { return y_; }
  const std::vector<double>& by_column() const { return by_column_; }

 private:
  void move(double u, const double* by, double h_s, std::size_t columns);

  LogChannel channel_;
  DelayColumn lag_;
  double y_;
  double u_before_ = 0.0;
  bool has_before_ = false;
  std::vector<double> by_column_;
  std::vector<double> by_before_;
};

}  // namespace awmr
