/// The commands of a log as functions of time. A command is held until the next row.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/model/dynamics.h"
#include "awmr/model/rest.h"
#include "awmr/trials/log.h"

namespace awmr {

/// A command that is constant between rows, and its integral over time. The mean over a time span
/// is a difference of integrals. It can be differentiated by a delay, although the command jumps.
class HeldSignal {
 public:
  HeldSignal(const std::vector<double>& t_s, const std::vector<double>& value);
  /// Integral from the log's first row to t. Before and after the log, the command has its first
  /// and last value.
  double integral(double t_s) const;
  /// Value of the command at t.
  double at(double t_s) const;

 private:
  std::size_t row_at(double t_s) const;
  const std::vector<double>* t_s_;
  const std::vector<double>* value_;
  std::vector<double> integral_;
};

/// The three commands of a log.
struct LogSignals {
  explicit LogSignals(const DrivingLog& log);
  const DrivingLog* log;
  HeldSignal left;
  HeldSignal right;
  HeldSignal steering;  ///< rad: the command, or the angle if no command was logged
};

/// Mean over [t, t + h] of a command that takes effect `delay_s` after it was logged.
template <class T>
T delayed_mean(const HeldSignal& signal, double t_s, double h_s, const T& delay_s) {
  // u: command, U: its integral, d: delay. mean = (U(t + h - d) - U(t - d))/h, with the derivative
  // -(u(t + h - d) - u(t - d))/h by d. The term slope (delay - d) is 0 and gives T this derivative.
  const double d = value_of(delay_s);
  const double mean = (signal.integral(t_s + h_s - d) - signal.integral(t_s - d)) / h_s;
  const double slope = -(signal.at(t_s + h_s - d) - signal.at(t_s - d)) / h_s;
  return T(mean) + slope * (delay_s - T(d));
}

}  // namespace awmr
