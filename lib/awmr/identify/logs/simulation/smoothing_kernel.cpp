#include "awmr/identify/logs/simulation/smoothing_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace awmr {
namespace {

/// Limits a variance to kWidestKernel. Returns 0 if the variance is not a positive number.
double bounded(double variance) { return variance > 0.0 ? std::min(variance, kWidestKernel) : 0.0; }

}  // namespace

SmoothingKernel gaussian_kernel(double variance) {
  constexpr double kReach = 6.0;  // width in standard deviations; weights beyond are below 1e-8
  constexpr double kShortest = 1e-8;
  variance = bounded(variance);
  const auto last = static_cast<std::size_t>(kReach * std::sqrt(variance)) + 10;
  // Weights by the downward recurrence of the Bessel functions, I_{n-1} = I_{n+1} + (2 n/s) I_n,
  // then scaled so that their sum is 1.
  std::vector<double> w(last + 2, 0.0);
  const double s = std::max(variance, kShortest);
  w[last] = 1e-200;
  double sum = 0.0;
  for (std::size_t n = last; n > 0; --n) {
    w[n - 1] = w[n + 1] + 2.0 * static_cast<double>(n) / s * w[n];
    sum += 2.0 * w[n];
  }
  sum += w[0];
  for (double& weight : w) weight /= sum;
  SmoothingKernel kernel{w, std::vector<double>(w.size(), 0.0)};
  for (std::size_t n = 0; n <= last; ++n) {
    const double before = n > 0 ? w[n - 1] : w[1];
    kernel.by_variance[n] = 0.5 * (before + w[n + 1]) - w[n];
  }
  return kernel;
}

SmoothingKernel moving_average(double variance) {
  variance = bounded(variance);
  // A moving average with k rows on either side of the middle row has the variance k (k + 1)/3.
  const auto whole = static_cast<std::size_t>(0.5 * (std::sqrt(1.0 + 12.0 * variance) - 1.0));
  const auto k = static_cast<double>(whole);
  const double rows = 2.0 * k + 1.0;
  const double squares = k * (k + 1.0) * rows / 3.0;
  const double next = (k + 1.0) * (k + 1.0);
  const double rest = next - variance;
  const double f = 0.5 * (variance * rows - squares) / rest;
  const double f_by = 0.5 * (rows * next - squares) / (rest * rest);
  const double sum = rows + 2.0 * f;
  const double inner_by = -2.0 * f_by / (sum * sum);
  SmoothingKernel kernel;
  kernel.weight.assign(whole + 2, 1.0 / sum);
  kernel.by_variance.assign(whole + 2, inner_by);
  kernel.weight.back() = f / sum;
  kernel.by_variance.back() = f_by / sum + f * inner_by;
  return kernel;
}

}  // namespace awmr
