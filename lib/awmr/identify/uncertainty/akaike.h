/// Akaike's criterion, by which families of resistance are compared. Private to identify/.
#pragma once

#include <cmath>
#include <optional>

namespace awmr {

/// AIC threshold: another family replaces the power law without a request if its AIC is lower by
/// this much. For correlated errors it is twice the common threshold, because the chord at rest, an
/// approximation in every family, also changes the AIC.
inline constexpr double kFamilyAicThreshold = 20.0;

/// AICc of n normal errors with unknown standard deviation and the sum of squares SSE. `free`
/// parameters are fitted in addition to the standard deviation, k = free + 1:
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
