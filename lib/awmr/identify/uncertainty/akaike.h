/// Akaike's information criterion for the comparison of resistance families. Private to identify/.
#pragma once

#include <cmath>
#include <optional>

namespace awmr {

/// Unless the user selects a family, another family replaces the power law if its AIC is lower by
/// this value. It is twice the usual threshold of 10, because the simulation replaces every
/// resistance by a straight line near rest, which also changes the AIC.
inline constexpr double kFamilyAicThreshold = 20.0;

/// AICc of a fit with n normal residuals, their sum of squares SSE and k = free + 1 estimated
/// parameters, which include the standard deviation:
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
