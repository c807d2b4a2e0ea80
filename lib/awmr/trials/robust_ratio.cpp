#include "awmr/trials/robust_ratio.h"
#include "awmr/core/sample_quantile.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace awmr {
namespace {

constexpr int kMinPairs = 10;
constexpr double kLargestSpread = 0.6;
/// Pairs (x, y) with a smaller |x| are skipped, because the vehicle is at rest.
constexpr double kSmallest = 1e-9;

}  // namespace

std::optional<RobustRatio> robust_ratio(std::span<const double> x, std::span<const double> y) {
  std::vector<double> sizes;
  for (const double value : x) sizes.push_back(std::abs(value));
  if (sizes.empty()) return std::nullopt;
  const double half = median(sizes);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (sizes[i] >= half && sizes[i] > kSmallest) ratios.push_back(y[i] / x[i]);
  }
  if (static_cast<int>(ratios.size()) < kMinPairs) return std::nullopt;
  const double ratio = median(ratios);
  const double spread = median_absolute_deviation(ratios, ratio) / std::abs(ratio);
  if (!std::isfinite(spread) || spread > kLargestSpread) return std::nullopt;
  return RobustRatio{ratio, spread, static_cast<int>(ratios.size())};
}

}  // namespace awmr
