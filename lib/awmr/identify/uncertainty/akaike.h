/// Akaike's criterion, by which families of resistance are compared. Private to identify/.
#pragma once

#include <cmath>
#include <optional>

namespace awmr {

/// AIC threshold: another family replaces the power law without a request if its AIC is lower by
/// this much. For correlated errors: twice what is commonly called decisive, since the chord at
/// rest, an approximation of every family, costs some.
inline constexpr double kFamilyAicThreshold = 20.0;

/// AICc of n normal errors of unknown deviation with the sum of squares SSE, `free` numbers fitted
/// in addition to the deviation, k = free + 1:
///
///     AICc = n ln(SSE/n) + 2 k + 2 k (k + 1)/(n - k - 1)
///
/// Empty if n <= k + 1, or SSE is not positive and finite.
inline std::optional<double> aicc(double sum_of_squares, double n, double free) {
  const double k = free + 1.0;
  if (n <= k + 1.0 || !(sum_of_squares > 0.0) || !std::isfinite(sum_of_squares)) {
    return std::nullopt;
  }
  return n * std::log(sum_of_squares / n) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
}

}  // namespace awmr
