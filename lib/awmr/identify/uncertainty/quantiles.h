/// Quantiles of distributions, for intervals and tests. Private to identify/.
#pragma once

namespace awmr {

/// 99.5 % quantile of the standard normal distribution: half width of a 99 % interval, in standard
/// deviations.
inline constexpr double kNormalQuantile995 = 2.576;

/// 97.5 % quantile of Student's t: half width of a 95 % interval in standard errors. Infinite if
/// degrees_of_freedom is not positive.
double t_quantile_95(double degrees_of_freedom);

/// 95 % quantile of the chi-squared distribution. Precondition: degrees_of_freedom > 0.
double chi_squared_quantile_95(double degrees_of_freedom);

}  // namespace awmr
