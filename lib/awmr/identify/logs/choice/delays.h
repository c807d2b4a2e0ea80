/// Search for delays, lags and constant errors of sensors and commands in a log fit. A term becomes
/// a free quantity of the fit if it lowers AIC significantly. Private to identify/.
#pragma once

#include <functional>
#include <vector>

#include "awmr/identify/logs/problem/noise_iteration.h"

namespace awmr {

/// A term that a fit lacks, with the value that its score test estimates.
struct CandidateTerm {
  FreeQuantity quantity;
  double value;
  double significance;  ///< |value| over its standard error by the noise model
  double gain;          ///< ScoreTest::gain
};

/// The terms of further_terms() to which a score test gives a value of more than three standard
/// errors, most significant first. `point`: the optimum without these terms.
std::vector<CandidateTerm> candidate_terms(const LogProblem& problem, const SearchPoint& point);

/// Adds terms of further_terms() one at a time to the converged fit `settled`, until none improves
/// the fit. Without them, other estimates would be biased: a latency of the speed, for example,
/// would increase the mass. Score tests (score_test.h) select the candidates. A short fit with each
/// candidate (one round of settle_noise()) ranks them. The best one is kept if its converged fit
/// lowers AIC by more than 10, the usual threshold of a clear difference.
/// Terms with a similar effect are tried next to a candidate, for example a motor lag and a filter
/// next to a delay (delays.cpp, term_trials.h, with_other_stop() in steering_linkage.h).
///
/// The search also ends if `ends` returns true for a fit with an added term.
NoiseIteration find_delays_and_errors(NoiseIteration settled,
                                      const std::function<bool(const NoiseIteration&)>& ends = {});

}  // namespace awmr
