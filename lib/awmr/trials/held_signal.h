/// The commands of a log as signals over time.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/model/dynamics.h"
#include "awmr/model/rest.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Integral over time of a command that is constant between rows. The mean over any span is a
/// difference of integrals, so its derivative by a delay exists although the command jumps.
class HeldSignal {
 public:
  HeldSignal(const std::vector<double>& t_s, const std::vector<double>& value);
  /// The integral up to t. Outside the log, the first or last value is used.
  double integral(double t_s) const;
  double at(double t_s) const;

 private:
  std::size_t row_at(double t_s) const;
  const std::vector<double>* t_s_;
  const std::vector<double>* value_;
  std::vector<double> integral_;
};

/// The commands of a log as held signals.
struct LogSignals {
  explicit LogSignals(const DrivingLog& log);
  const DrivingLog* log;
  HeldSignal left;
  HeldSignal right;
  HeldSignal steering;  ///< the command, or the angle if only that was logged
};

/// Mean of a command over [t, t + h] as it arrives `delay_s` later.
template <class T>
T delayed_mean(const HeldSignal& signal, double t_s, double h_s, const T& delay_s) {
  // mean = (U(t + h - d) - U(t - d))/h, whose derivative by d is -(u(t + h - d) - u(t - d))/h. The
  // linear term, whose value is zero, gives T this derivative.
  const double d = value_of(delay_s);
  const double mean = (signal.integral(t_s + h_s - d) - signal.integral(t_s - d)) / h_s;
  const double slope = -(signal.at(t_s + h_s - d) - signal.at(t_s - d)) / h_s;
  return T(mean) + slope * (delay_s - T(d));
}

}  // namespace awmr
