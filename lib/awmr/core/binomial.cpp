#include "awmr/core/binomial.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "awmr/core/distributions.h"

namespace awmr {

Interval clopper_pearson(std::size_t successes, std::size_t runs) {
  using Binomial = boost::math::binomial_distribution<double>;
  const auto k = static_cast<double>(successes);
  const auto n = static_cast<double>(runs);
  constexpr double kTail = 0.025;
  return {successes == 0 ? 0.0 : Binomial::find_lower_bound_on_p(n, k, kTail),
          successes == runs ? 1.0 : Binomial::find_upper_bound_on_p(n, k, kTail)};
}

double mcnemar_p(std::size_t only_first, std::size_t only_second) {
  const std::size_t split = only_first + only_second;
  if (split == 0) return 1.0;
  const boost::math::binomial_distribution<double> fair(static_cast<double>(split), 0.5);
  const auto fewer = static_cast<double>(std::min(only_first, only_second));
  return std::min(1.0, 2.0 * boost::math::cdf(fair, fewer));
}

double paired_t_p(double mean, double deviation, std::size_t count) {
  const auto n = static_cast<double>(count);
  const double error = deviation / std::sqrt(n);
  // A standard error below 1e-12 of the mean comes from rounding alone: all differences are equal.
  // The t statistic is then undefined; p is 1 for a mean of 0, else 0.
  if (!(error > 1e-12 * std::abs(mean))) return std::abs(mean) > 0.0 ? 0.0 : 1.0;
  return 2.0 * students_t_tail(std::abs(mean) / error, n - 1.0);
}

double equivalence_p(double mean, double deviation, std::size_t count, double margin) {
  const auto n = static_cast<double>(count);
  const double error = deviation / std::sqrt(n);
  const double inside = margin - std::abs(mean);
  if (!(error > 1e-12 * std::abs(mean))) return inside >= 0.0 ? 0.0 : 1.0;
  return students_t_tail(inside / error, n - 1.0);
}

}  // namespace awmr
