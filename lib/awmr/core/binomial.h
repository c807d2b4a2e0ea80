/// Exact statements about shares.
#pragma once

#include <cstddef>

#include "awmr/core/interval.h"

namespace awmr {

/// Clopper and Pearson's 95 % interval of a probability of which `successes` of `runs` came true:
/// covers at least 95 %, whatever the probability. runs >= 1.
Interval clopper_pearson(std::size_t successes, std::size_t runs);

/// Two-sided exact McNemar test of two paired shares, where `only_first` pairs came true for the
/// first alone and `only_second` for the second alone: the probability of a split as uneven, were
/// both shares the same.
double mcnemar_p(std::size_t only_first, std::size_t only_second);

/// Two-sided p of the paired t test: the mean of `count` >= 2 differences with this mean and
/// standard deviation, were the true one 0. Without any spread: 1 for mean 0, else 0.
double paired_t_p(double mean, double deviation, std::size_t count);

/// The larger p of the two one-sided t tests (TOST) of a mean beyond `margin` >= 0 on either side:
/// below 0.05 the true one is within the margin. Without any spread: 0 within, else 1.
double equivalence_p(double mean, double deviation, std::size_t count, double margin);

}  // namespace awmr
