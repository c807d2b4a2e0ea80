/// Exact statistics of proportions and paired differences.
#pragma once

#include <cstddef>

#include "awmr/core/interval.h"

namespace awmr {

/// Clopper-Pearson 95 % interval of the probability of success, from `successes` in `runs`. Covers
/// at least 95 %, whatever the probability. runs >= 1.
Interval clopper_pearson(std::size_t successes, std::size_t runs);

/// Two-sided exact McNemar test of two paired proportions: `only_first` pairs succeeded in the
/// first only, `only_second` in the second only. Returns the probability of a split at least as
/// uneven if both proportions are equal.
double mcnemar_p(std::size_t only_first, std::size_t only_second);

/// Two-sided p of the paired t test for a true mean of 0: `count` >= 2 differences with this mean
/// and standard deviation. With zero deviation: 1 for mean 0, else 0.
double paired_t_p(double mean, double deviation, std::size_t count);

/// The larger p of the two one-sided t tests (TOST) of a mean beyond +-`margin`, margin >= 0. Below
/// 0.05, the true mean is within the margin. With zero deviation: 0 within, else 1.
double equivalence_p(double mean, double deviation, std::size_t count, double margin);

}  // namespace awmr
