/// Ratio y/x of two signals, computed from medians so that about 10 % outliers do no harm.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace awmr {

struct RobustRatio {
  double ratio = 0.0;
  /// Median absolute deviation of the ratios y/x from `ratio`, divided by |ratio|.
  double spread = 0.0;
  int pairs = 0;  ///< number of pairs used
};

/// Returns the median of y/x over the half of the pairs (x, y) with the larger |x|. Empty if this
/// half has fewer than 10 pairs, or if `spread` would exceed 0.6: the two signals are then not
/// proportional.
std::optional<RobustRatio> robust_ratio(std::span<const double> x, std::span<const double> y);

}  // namespace awmr
