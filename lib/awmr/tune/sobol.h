/// Which input moves an output: Sobol's indices. Private to this folder.
///
/// With independent inputs x_i, V = Var f:
///   first order  S_i  = Var(E[f | x_i])/V            what is gone of V once x_i is known
///   total        ST_i = E[Var(f | all but x_i)]/V    what is left of V while x_i alone is not known
/// From samples A and B of all inputs, and A with the i-th input of B (AB_i), by Jansen's estimators
/// (M. Jansen, Computer Physics Communications 117, 1999, as in A. Saltelli et al., same journal 181, 2010):
///   S_i  = 1 - sum_j (f(B_j) - f(AB_ij))^2/(2 N V),   ST_i = sum_j (f(A_j) - f(AB_ij))^2/(2 N V)
#pragma once

#include <cstdint>
#include <vector>

#include "awmr/tune/tune.h"

namespace awmr {

/// By input. `of_a`, `of_b`: f at the samples, 2 or more; `of_mixed`: by input, then sample. Intervals are the 95 %
/// percentiles over bootstrap resamples of j. An output that does not vary has indices of 0.
std::vector<SobolIndex> sobol_indices(const std::vector<double>& of_a,
                                      const std::vector<double>& of_b,
                                      const std::vector<std::vector<double>>& of_mixed,
                                      std::uint64_t seed);

}  // namespace awmr
