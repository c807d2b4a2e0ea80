/// Quantiles for intervals. Private to identify/.
#pragma once

namespace awmr {

inline constexpr double kNormalQuantile995 = 2.576;  ///< two-sided 99 % of the standard normal

/// Ratio of the half width of a 95 % interval to its standard error: the 97.5 % quantile of
/// Student's t. Precondition: degrees_of_freedom > 0.
double t_quantile_95(double degrees_of_freedom);

/// 95 % quantile of the chi-squared distribution. Precondition: degrees_of_freedom > 0.
double chi_squared_quantile_95(double degrees_of_freedom);

}  // namespace awmr
