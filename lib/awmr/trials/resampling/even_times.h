/// Spacing of rows or readings in time. Private to trials/.
#pragma once

#include <span>
#include <vector>

namespace awmr {

/// Steps between successive times.
std::vector<double> steps_of(std::span<const double> t_s);
/// Median of these steps.
double median_step_of(std::span<const double> t_s);

/// The times t_n = t_0 + n h.
struct EvenTimes {
  double first_s = 0.0;  ///< t_0
  double step_s = 0.0;   ///< h
  double at(double number) const { return first_s + number * step_s; }
};

/// Least-squares fit of t_0 + n_k h to the times t_k. `numbers`: n_k, at least two different ones.
EvenTimes even_times(std::span<const double> t_s, std::span<const double> numbers);

}  // namespace awmr
