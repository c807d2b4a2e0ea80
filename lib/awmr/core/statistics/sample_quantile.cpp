#include "awmr/core/statistics/sample_quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace awmr {
namespace {

/// Tolerance for rounding errors of the rank p n: a rank above a whole number by at most this
/// counts as the whole number.
constexpr double kRounding = 1e-9;

double between(double below, double above, double share) {
  return share > 0.0 ? below + share * (above - below) : below;
}

}  // namespace

double quantile_of_sorted(std::span<const double> sorted, double p) {
  const double position = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return between(sorted[below], sorted[above], position - static_cast<double>(below));
}

double quantile(std::vector<double> values, double p) {
  const double position = p * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(std::floor(position));
  std::nth_element(values.begin(), below, values.end());
  const double above =
      below + 1 < values.end() ? *std::min_element(below + 1, values.end()) : *below;
  return between(*below, above, position - std::floor(position));
}

double rank_quantile(std::vector<double> values, double p) {
  const double rank = std::ceil(p * static_cast<double>(values.size()) - kRounding);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(1.0, rank)) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_absolute_deviation(std::span<const double> values, double middle) {
  std::vector<double> deviations;
  deviations.reserve(values.size());
  for (const double value : values) deviations.push_back(std::abs(value - middle));
  return median(std::move(deviations));
}

}  // namespace awmr
