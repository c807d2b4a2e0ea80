/// Confidence interval of a proportion, and tests of paired proportions and paired differences.
#pragma once

#include <cstddef>

#include "awmr/core/interval.h"

namespace awmr {

/// Clopper-Pearson 95 % interval of the probability of success, for `successes` in `runs` >= 1. The
/// interval contains the true probability in at least 95 % of samples, whatever this probability
/// is.
Interval clopper_pearson(std::size_t successes, std::size_t runs);

/// p value of the two-sided exact McNemar test that two paired proportions are equal. `only_first`:
/// number of pairs in which only the first succeeded; `only_second`: only the second. Returns 1 if
/// both numbers are 0.
double mcnemar_p(std::size_t only_first, std::size_t only_second);

/// p value of the two-sided paired t test that the true mean difference is 0. `mean` and
/// `deviation` (standard deviation) are those of `count` >= 2 differences. For a deviation of 0,
/// returns 1 if the mean is 0, else 0.
double paired_t_p(double mean, double deviation, std::size_t count);

/// p value of the equivalence test (TOST): the larger p of two one-sided t tests. Their hypotheses
/// are that the true mean is above `margin`, or below -`margin`; `margin` >= 0. p < 0.05: the mean
/// is significantly within the margin. For a deviation of 0, returns 0 if `mean` is within the
/// margin, else 1.
double equivalence_p(double mean, double deviation, std::size_t count, double margin);

}  // namespace awmr
