/// Probabilities and quantiles of the normal, t, chi-squared, F and beta distributions. Wraps
/// Boost.Math, which is slow to compile. Private: not installed.
#pragma once

namespace awmr {

/// P(Z <= z), Z standard normal.
double normal_cdf(double z);
/// P(Z > z), accurate for large z too.
double normal_tail(double z);

/// P(T > t), T Student's t with degrees_of_freedom > 0.
double students_t_tail(double t, double degrees_of_freedom);
/// The t with P(T <= t) = p, 0 < p < 1.
double students_t_quantile(double p, double degrees_of_freedom);
/// 97.5 % quantile of Student's t: half width of a 95 % interval, divided by the standard error.
/// Infinity if there are no degrees of freedom.
double t_quantile_95(double degrees_of_freedom);

/// P(X > x), X chi-squared with degrees_of_freedom > 0; x >= 0.
double chi_squared_tail(double x, double degrees_of_freedom);
/// The x with P(X <= x) = p, 0 <= p < 1.
double chi_squared_quantile(double p, double degrees_of_freedom);

/// P(F > f), F Fisher's F with both degrees of freedom > 0; f >= 0.
double fisher_f_tail(double f, double numerator_dof, double denominator_dof);

/// P(B > x), B of the beta distribution with the shape parameters alpha, beta > 0; 0 <= x <= 1.
double beta_tail(double x, double alpha, double beta);
/// The x with P(B <= x) = p, 0 <= p <= 1.
double beta_quantile(double p, double alpha, double beta);
/// The x with P(B > x) = p, accurate for small p too.
double beta_tail_quantile(double p, double alpha, double beta);

}  // namespace awmr
