/// Symmetric kernels that smooth a channel over the rows of a log. Private to identify/.
#pragma once

#include <vector>

namespace awmr {

/// Weights w_n of the rows i - n and i + n in the smoothed value of row i,
///
///     y_i = w_0 x_i + sum_{n > 0} w_n (x_{i-n} + x_{i+n})
///
/// The sum of all weights is 1. `by_variance`: derivatives of the weights with respect to the
/// variance of the kernel (rows^2).
struct SmoothingKernel {
  std::vector<double> weight;
  std::vector<double> by_variance;
};

/// Largest variance of a kernel, rows^2. A larger variance is replaced by this value, and NaN by 0.
inline constexpr double kWidestKernel = 2500.0;

/// Discrete Gaussian kernel of the variance s >= 0 (rows^2) [Lindeberg, Scale-space for discrete
/// signals, 1990]. With the modified Bessel functions I_n, the weights are
///
///     w_n = e^-s I_n(s),   dw_n/ds = (w_{n-1} + w_{n+1})/2 - w_n
SmoothingKernel gaussian_kernel(double variance);

/// Moving average with the variance s >= 0 (rows^2). The k rows on either side have the weight of
/// the middle row, and the next row on either side has f times this weight, f in [0, 1). k and f
/// follow from
///
///     s = (2 sum_{n <= k} n^2 + 2 f (k + 1)^2)/(2 k + 1 + 2 f)
SmoothingKernel moving_average(double variance);

}  // namespace awmr
