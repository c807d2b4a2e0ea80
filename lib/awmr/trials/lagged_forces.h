/// Computes the wheel forces of motors with a first-order lag from the commands of a log.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/trials/held_signal.h"

namespace awmr {

/// After this many time constants of a motor, the rest of a command's effect is exp(-40) = 4e-18,
/// below rounding.
inline constexpr double kForgottenLags = 40.0;

/// Rows whose commands affect the forces in `rows`, if a command has an effect for `memory_s` and
/// delays of the commands are -1 to 1 s.
RowSpan rows_with_effect(const DrivingLog& log, RowSpan rows, double memory_s);

/// Forces F' of motors with the time constant T (`lag_s`), and their derivatives with respect to T.
/// For a constant command c:
///
///     T dF'/dt = c - F',   F'(t + h) = c + (F'(t) - c) exp(-h/T)
///     mean over [t, t + h] = mean of c - (T/h) (F'(t + h) - F'(t))
///
/// The computation starts with F' = c, 40 T plus the longest delay before the first requested row,
/// or at the log's first row. Commands before that time change the result by less than rounding
/// does. With T = 0, F' = c at all times.
class LaggedForces {
 public:
  /// Covers the rows [begin, end) of the log, and command delays from -1 to 1 s. The log must
  /// outlive this object.
  LaggedForces(const DrivingLog& log, std::size_t begin, std::size_t end, double lag_s);

  double time_constant_s() const { return lag_s_; }

  /// Mean force over a time span, and its derivatives with respect to T and to the delay, 1/s.
  struct Mean {
    SideForces<double> force;
    SideForces<double> by_lag;
    SideForces<double> by_delay;
  };
  /// Computes the mean forces over [t, t + h] if the commands reach the motors `delay_s` after they
  /// were logged. `signals`: signals of the same log.
  Mean mean(const LogSignals& signals, double t_s, double h_s, double delay_s) const;

 private:
  struct Side {
    std::vector<double> force;   ///< F' at the time of each row
    std::vector<double> by_lag;  ///< derivative of `force` with respect to T, 1/s
  };
  struct Value {
    double force;
    double by_lag;
  };
  Side side(const std::vector<double>& command, std::size_t end) const;
  /// Returns the force at the time `t_s`. With T = 0 and a command that changes at `t_s`, the force
  /// still has the value before the change.
  Value at(const Side& side, const std::vector<double>& command, double t_s) const;

  const DrivingLog* log_;
  double lag_s_;
  std::size_t first_row_;  ///< row of the log to which the first elements of left_, right_ belong
  Side left_;
  Side right_;
};

}  // namespace awmr
