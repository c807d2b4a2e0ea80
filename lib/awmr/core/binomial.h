/// Confidence interval of a proportion, and tests of paired proportions and paired differences.
#pragma once

#include <cstddef>

#include "awmr/core/interval.h"

namespace awmr {

/// Clopper-Pearson 95 % interval of the probability of success, for `successes` in `runs` >= 1.
/// Whatever the true probability is, at least 95 % of such intervals contain it.
Interval clopper_pearson(std::size_t successes, std::size_t runs);

/// p value of the two-sided exact McNemar test that two paired proportions are equal. `only_first`:
/// number of pairs in which only the first succeeded; `only_second`: only the second. Returns 1 if
/// both numbers are 0.
double mcnemar_p(std::size_t only_first, std::size_t only_second);

/// p value of the two-sided paired t test of the hypothesis that the true mean difference is 0.
/// `mean` and `deviation`: mean and standard deviation of the differences; `count`: their number,
/// >= 2. If the deviation is 0, returns 1 for a mean of 0, else 0.
double paired_t_p(double mean, double deviation, std::size_t count);

/// p value of an equivalence test of paired differences (TOST, two one-sided t tests). If p < 0.05,
/// the true mean is significantly within +-`margin`, >= 0. The null hypotheses are that the true
/// mean is above `margin`, and that it is below -`margin`; p is the larger of the two p values.
/// `mean`, `deviation` and `count`: as in paired_t_p(). If the deviation is 0, returns 0 for a mean
/// within the margin, else 1.
double equivalence_p(double mean, double deviation, std::size_t count, double margin);

}  // namespace awmr
