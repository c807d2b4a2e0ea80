/// Ratio of two signals by medians, which tolerates about 10 % outliers.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace awmr {

struct RobustRatio {
  double ratio = 0.0;
  double spread = 0.0;  ///< median absolute deviation of the pairs' y/x, divided by |ratio|
  int pairs = 0;        ///< number of pairs used
};

/// Median of y/x over the half of the pairs with the larger |x|. Empty if there are fewer than 10
/// such pairs, or if `spread` would exceed 0.6: the two signals are then not proportional.
std::optional<RobustRatio> robust_ratio(std::span<const double> x, std::span<const double> y);

}  // namespace awmr
