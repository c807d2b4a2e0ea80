#include "awmr/identify/uncertainty/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"

namespace awmr {
namespace {

constexpr std::size_t kMinForShape = 8;
constexpr double kSignificant = 0.05;

double mean_of(std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

/// p value of the Anderson-Darling statistic A^2 of n residuals. `a`: the modified statistic A* =
/// A^2 (1 + 0.75/n + 2.25/n^2).
double anderson_darling_p(double a) {
  if (a >= 0.6) return std::exp(1.2937 - 5.709 * a + 0.0186 * a * a);
  if (a >= 0.34) return std::exp(0.9177 - 4.279 * a - 1.38 * a * a);
  if (a >= 0.2) return 1.0 - std::exp(-8.318 + 42.796 * a - 59.938 * a * a);
  return 1.0 - std::exp(-13.436 + 101.14 * a - 223.73 * a * a);
}

std::string verdict(double p, const char* passed, const char* failed) {
  return p < kSignificant ? failed : passed;
}

}  // namespace

std::optional<Diagnostic> normality(std::span<const double> residuals) {
  const std::size_t n = residuals.size();
  if (n < kMinForShape) return std::nullopt;
  std::vector<double> x(residuals.begin(), residuals.end());
  std::sort(x.begin(), x.end());
  const double mean = mean_of(x);
  double squares = 0.0;
  for (const double e : x) squares += (e - mean) * (e - mean);
  const double sd = std::sqrt(squares / static_cast<double>(n - 1));
  if (!(sd > 0.0) || !std::isfinite(sd)) return std::nullopt;
  const double size = static_cast<double>(n);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    // Lower limit of probabilities: far in a tail, a probability rounds to 0, which has no
    // logarithm.
    const double tiny = 1e-300;
    const double below = std::max(tiny, normal_cdf((x[i] - mean) / sd));
    const double above = std::max(tiny, normal_tail((x[n - 1 - i] - mean) / sd));
    sum += (2.0 * static_cast<double>(i) + 1.0) * (std::log(below) + std::log(above));
  }
  const double a = (-size - sum / size) * (1.0 + 0.75 / size + 2.25 / (size * size));
  const double p = std::clamp(anderson_darling_p(a), 0.0, 1.0);
  return Diagnostic{
      "normality", a, p,
      verdict(p, "no significant deviation from normal residuals",
              "the residuals are not normal: check for outliers, or use a robust loss")};
}

std::optional<Diagnostic> whiteness(std::span<const double> residuals, int lags) {
  const auto n = static_cast<int>(residuals.size());
  if (n <= lags + 1) return std::nullopt;
  const double mean = mean_of(residuals);
  double variance = 0.0;
  for (const double e : residuals) variance += (e - mean) * (e - mean);
  if (!(variance > 0.0) || !std::isfinite(variance)) return std::nullopt;
  double q = 0.0;
  for (int k = 1; k <= lags; ++k) {
    double sum = 0.0;
    for (int i = k; i < n; ++i) {
      sum += (residuals[at(i)] - mean) * (residuals[at(i - k)] - mean);
    }
    const double rho = sum / variance;
    q += rho * rho / (n - k);
  }
  q *= static_cast<double>(n) * (n + 2.0);
  const double p = chi_squared_tail(q, lags);
  return Diagnostic{
      "whiteness", q, p,
      verdict(
          p, "no significant correlation",
          "successive residuals are correlated, so the model or the noise model is incomplete")};
}

std::optional<Diagnostic> curvature(std::span<const double> forces,
                                    const Eigen::VectorXd& residuals) {
  const std::size_t n = forces.size();
  if (n < kMinForShape) return std::nullopt;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return forces[a] < forces[b]; });
  double steps = 0.0;
  double squares = 0.0;
  const double mean = residuals.mean();
  for (std::size_t i = 0; i < n; ++i) {
    const double e = residuals(eigen_index(order[i]));
    squares += (e - mean) * (e - mean);
    if (i == 0) continue;
    const double step = e - residuals(eigen_index(order[i - 1]));
    steps += step * step;
  }
  if (!(squares > 0.0) || !std::isfinite(squares) || !std::isfinite(steps)) return std::nullopt;
  const double size = static_cast<double>(n);
  // Von Neumann's ratio; its expected value is 2 for white noise.
  const double ratio = steps / squares;
  const double deviation = std::sqrt(4.0 * (size - 2.0) / (size * size - 1.0));
  const double p = normal_cdf((ratio - 2.0) / deviation);
  return Diagnostic{
      "curvature", ratio, p,
      verdict(p, "no significant deviation from the shape of the curve",
              "runs at similar forces deviate from the fitted curve to the same side, so the "
              "resistance has another shape than the curve: compare other families (family auto)")};
}

std::optional<Diagnostic> lack_of_fit(std::span<const double> forces,
                                      const Eigen::VectorXd& residuals, int parameters) {
  std::map<double, std::vector<double>> groups;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    groups[forces[i]].push_back(residuals(eigen_index(i)));
  }
  double pure = 0.0;
  double between = 0.0;
  for (const auto& [force, group] : groups) {
    const double mean = mean_of(group);
    between += static_cast<double>(group.size()) * mean * mean;
    for (const double e : group) pure += (e - mean) * (e - mean);
  }
  const auto pure_dof = static_cast<double>(forces.size() - groups.size());
  const double between_dof = static_cast<double>(groups.size()) - parameters;
  if (pure_dof < 1.0 || between_dof < 1.0 || !(pure > 0.0)) return std::nullopt;
  const double f = (between / between_dof) / (pure / pure_dof);
  if (!std::isfinite(f)) return std::nullopt;
  const double p = fisher_f_tail(f, between_dof, pure_dof);
  return Diagnostic{
      "lack of fit", f, p,
      verdict(p, "no significant lack of fit",
              "lack of fit: the runs are farther from the curve than repeated runs are from each "
              "other, so the curve has a wrong shape: compare other families (family auto)")};
}

Eigen::VectorXd studentised(const Eigen::VectorXd& residuals, const Eigen::VectorXd& leverages,
                            int degrees_of_freedom) {
  if (degrees_of_freedom < 2 || leverages.size() == 0) return {};
  Eigen::VectorXd t(residuals.size());
  const double sse = residuals.squaredNorm();
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    const double free = 1.0 - leverages(i);
    const double e = residuals(i);
    const double without = (sse - e * e / free) / (degrees_of_freedom - 1.0);
    // A row with leverage 1 is the only one that determines some parameter. Its residual is always
    // 0 and cannot be tested.
    const double evaluated = free > 1e-12 && without > 0.0 ? e / std::sqrt(without * free) : 0.0;
    t(i) = std::isfinite(evaluated) ? evaluated : 0.0;
  }
  return t;
}

}  // namespace awmr
