/// Wheel forces of motors with a first-order lag, from the commands of a log.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/trials/held_signal.h"

namespace awmr {

/// Forces F' of motors with the time constant T, with their derivatives by T. For a constant
/// command c:
///
///     T dF'/dt = c - F',   F'(t + h) = c + (F'(t) - c) exp(-h/T)
///     mean over [t, t + h] = mean of c - (T/h) (F'(t + h) - F'(t))
///
/// F' starts at c so many time constants before the requested rows that earlier commands have less
/// effect than rounding, or at the first row of the log. With T = 0, F' = c.
class LaggedForces {
 public:
  /// For the rows [begin, end) of the log, and delays of up to a second in either direction. The
  /// log must outlive it.
  LaggedForces(const DrivingLog& log, std::size_t begin, std::size_t end, double lag_s);

  /// The mean over a span, and its derivatives.
  struct Mean {
    SideForces<double> force;
    SideForces<double> by_lag;
    SideForces<double> by_delay;
  };
  /// Over [t, t + h], if the commands reach the motors with the latency `delay_s`. `signals`: of
  /// the same log.
  Mean mean(const LogSignals& signals, double t_s, double h_s, double delay_s) const;

 private:
  struct Side {
    std::vector<double> force;   ///< by row, as the row begins
    std::vector<double> by_lag;  ///< by row
  };
  struct Value {
    double force;
    double by_lag;
  };
  Side side(const std::vector<double>& command, std::size_t end) const;
  /// At `t_s`, before a command that begins at this time.
  Value at(const Side& side, const std::vector<double>& command, double t_s) const;

  const DrivingLog* log_;
  double lag_s_;
  std::size_t first_row_;  ///< first row of the two vectors below
  Side left_;
  Side right_;
};

}  // namespace awmr
