#include "even_times.h"

#include <cstddef>

#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {

std::vector<double> steps_of(std::span<const double> t_s) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < t_s.size(); ++i) steps_s.push_back(t_s[i] - t_s[i - 1]);
  return steps_s;
}

double median_step_of(std::span<const double> t_s) { return median(steps_of(t_s)); }

EvenTimes even_times(std::span<const double> t_s, std::span<const double> numbers) {
  const auto n = static_cast<double>(t_s.size());
  double mean_number = 0.0;
  double mean_s = 0.0;  // after the first time, so that large times lose no digits
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    mean_number += numbers[k] / n;
    mean_s += (t_s[k] - t_s.front()) / n;
  }
  double across = 0.0;
  double along = 0.0;
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    const double number = numbers[k] - mean_number;
    across += number * (t_s[k] - t_s.front() - mean_s);
    along += number * number;
  }
  const double step_s = across / along;
  return {t_s.front() + mean_s - step_s * mean_number, step_s};
}

}  // namespace awmr
