#include "awmr/core/statistics/binomial.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/statistics/distributions.h"

namespace awmr {

// The binomial probabilities are tails of the beta distribution:
//     P(K >= k) = P(B <= p), B ~ Beta(k, n - k + 1);  P(K <= k) = P(B > p), B ~ Beta(k + 1, n - k)
Interval clopper_pearson(std::size_t successes, std::size_t runs) {
  const auto k = static_cast<double>(successes);
  const auto n = static_cast<double>(runs);
  constexpr double kTail = 0.025;
  return {successes == 0 ? 0.0 : beta_quantile(kTail, k, n - k + 1.0),
          successes == runs ? 1.0 : beta_tail_quantile(kTail, k + 1.0, n - k)};
}

double mcnemar_p(std::size_t only_first, std::size_t only_second) {
  const std::size_t split = only_first + only_second;
  if (split == 0) return 1.0;
  const auto n = static_cast<double>(split);
  const auto fewer = static_cast<double>(std::min(only_first, only_second));
  return std::min(1.0, 2.0 * beta_tail(0.5, fewer + 1.0, n - fewer));
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
