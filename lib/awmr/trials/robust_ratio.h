/// Medians, and how many times one signal is another by them: a tenth of wild pairs does not move
/// it.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace awmr {

/// Precondition: not empty. The upper of the two middle values where their number is even.
double median(std::vector<double> values);

/// The median of |value - middle|, `middle` being the values' own median. Precondition: not empty.
double median_absolute_deviation(std::span<const double> values, double middle);
/// The standard deviation of normal values over their median absolute deviation.
inline constexpr double kStdPerMad = 1.4826;

struct RobustRatio {
  double ratio = 0.0;
  double spread = 0.0;  ///< median absolute deviation of the ratios over |ratio|
  int pairs = 0;        ///< that the ratio rests on
};

/// The median of y/x over the half of the pairs with the larger |x|. None with fewer than 10 such
/// pairs, or where the ratios scatter by more than 0.6 of their size: then the two signals do not
/// follow each other.
std::optional<RobustRatio> robust_ratio(std::span<const double> x, std::span<const double> y);

}  // namespace awmr
