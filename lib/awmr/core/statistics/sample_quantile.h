/// Quantiles and medians of samples. Private: not installed.
#pragma once

#include <span>
#include <vector>

namespace awmr {

/// The p quantile, linear between order statistics (type 7 of Hyndman and Fan). `sorted` is
/// ascending and not empty, p in [0, 1].
double quantile_of_sorted(std::span<const double> sorted, double p);
/// The p quantile, as by quantile_of_sorted(), of values in any order. `values` is not empty.
double quantile(std::vector<double> values, double p);

/// The smallest value v such that at least the fraction p of the values is <= v (type 1 of Hyndman
/// and Fan), for statements such as "95 % of the runs need at most 3 s". `values` is not empty, p
/// in [0, 1].
double rank_quantile(std::vector<double> values, double p);

/// Median; for an even number of values the upper of the two middle ones, so that the result is
/// always one of the values. `values` is not empty.
double median(std::vector<double> values);
/// Median of |value - middle|, where `middle` is the median of the values. `values` is not empty.
double median_absolute_deviation(std::span<const double> values, double middle);
/// Ratio of the standard deviation to the median absolute deviation of a normal distribution.
inline constexpr double kStdPerMad = 1.4826;

}  // namespace awmr
