/// Akaike's information criterion for the comparison of resistance families (forms of the
/// resistance law). Private to identify/.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

namespace awmr {

/// Decrease of AIC above which a log fit uses another resistance family than the power law, or an
/// extension of the model (back-EMF, Stribeck friction, another timing of the commands). Does not
/// apply to what the user requested. The value is twice the usual threshold of 10, because the
/// simulation itself changes the AIC: near rest, it replaces the resistance (except Coulomb
/// friction) by a straight line. The finding `power-law-inadequate` of coast-down curves has the
/// same threshold.
inline constexpr double kFamilyAicThreshold = 20.0;

/// Decrease of AIC above which a log fit adds a term (delay, lag, force, or error of a command or
/// sensor), or prefers one of two explanations.
inline constexpr double kTermAicThreshold = 10.0;

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

/// Text of a decrease of AIC, for a message that says "lower by ...". A large difference follows
/// from the assumed noise, not from the evidence, so its digits mean nothing.
inline std::string aic_decrease_text(double decrease, int decimals = 0) {
  constexpr double kClear = 1000.0;
  if (decrease > kClear) return "more than 1,000";
  return fmt::format("{:.{}f}", decrease, decimals);
}

}  // namespace awmr
