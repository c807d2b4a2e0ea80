/// Computes Sobol indices: the fractions of an output's variance that are due to each input.
/// Private to tune/.
///
/// With independent inputs x_i, V = Var f:
///   first order  S_i  = Var(E[f | x_i])/V            fraction of V that knowing x_i removes
///   total        ST_i = E[Var(f | all but x_i)]/V    fraction that remains if only x_i is unknown
/// From samples A and B of all inputs, and A with the i-th input of B (AB_i), by Jansen's
/// estimators (M. Jansen, Computer Physics Communications 117, 1999, as in A. Saltelli et al., same
/// journal 181, 2010):
///   S_i  = 1 - sum_j (f(B_j) - f(AB_ij))^2/(2 N V),   ST_i = sum_j (f(A_j) - f(AB_ij))^2/(2 N V)
#pragma once

#include <cstdint>
#include <vector>

#include "awmr/tune/tune.h"

namespace awmr {

/// Returns the indices of each input. `of_a`, `of_b`: f at the samples A and B, two or more each;
/// `of_mixed`: f at AB_i, by input, then sample. Intervals: 2.5 and 97.5 % percentiles over
/// bootstrap resamples of the samples. The indices of a constant output are 0.
std::vector<SobolIndex> sobol_indices(const std::vector<double>& of_a,
                                      const std::vector<double>& of_b,
                                      const std::vector<std::vector<double>>& of_mixed,
                                      std::uint64_t seed);

}  // namespace awmr
