/// Confidence interval of a proportion, and tests of paired proportions and paired differences.
#pragma once

#include <cstddef>

#include "awmr/core/interval.h"

namespace awmr {

/// Clopper-Pearson 95 % interval of the probability of success, for `successes` in `runs` >= 1. For
/// any true probability, at least 95 % of such intervals contain it.
Interval clopper_pearson(std::size_t successes, std::size_t runs);

/// p value of the two-sided exact McNemar test, which compares two success rates on the same items.
/// `only_first`: number of items for which only the first succeeded; `only_second`: only the
/// second. Returns 1 if both numbers are 0.
double mcnemar_p(std::size_t only_first, std::size_t only_second);

/// p value of the two-sided paired t test of the hypothesis that the true mean difference is 0.
/// `mean`, `deviation`: mean and standard deviation of the `count` >= 2 differences. If the
/// deviation is 0, returns 1 for a mean of 0, else 0.
double paired_t_p(double mean, double deviation, std::size_t count);

/// p value of an equivalence test of paired differences (TOST, two one-sided t tests). If p < 0.05,
/// the true mean is significantly within +-`margin`, >= 0. p is the larger of the p values of two
/// hypotheses: the true mean is above `margin`; it is below -`margin`. `mean`, `deviation`,
/// `count`: as in paired_t_p(). If the deviation is 0, returns 0 for a mean within the margin, else
/// 1.
double equivalence_p(double mean, double deviation, std::size_t count, double margin);

}  // namespace awmr
