/// Rao score test for adding one parameter to a fit. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

struct ScoreTest {
  double value = 0.0;      ///< estimate by one Gauss-Newton step from 0
  double std_error = 0.0;  ///< of the value: the larger of that by the noise model and that by the
                           ///< blocks' scatter
  double noise_error = 0.0;  ///< of the value, by the noise model alone
  double gain = 0.0;         ///< decrease of -2 ln L: (value / std_error)^2
};

/// Rao's score test of each candidate at 0, with all quantities of the problem free and the other
/// candidates fixed at 0. With the information H and the scores g of the coordinates t and a
/// candidate c,
///
///     value = -(g_c - H_ct H_tt^-1 g_t) / (H_cc - H_ct H_tt^-1 H_tc)
///
/// Drift is replaced by white noise of equal variance, so that it cannot absorb the effect of a
/// candidate. The standard error is then that of the blocks' scatter. `point`: the solution without
/// the candidates. Precondition: candidates are linear quantities.
std::vector<ScoreTest> score_test(const LogProblem& problem, const SearchPoint& point,
                                  const std::vector<FreeQuantity>& candidates);

/// The problem with white noise of the same standard deviation in every channel, so that the model
/// has to explain the drift.
LogProblem with_white_noise(LogProblem problem);

/// The problem and the point with further free quantities at their initial values.
struct Extended {
  LogProblem problem;
  SearchPoint point;
};
Extended extended(LogProblem problem, SearchPoint point, const std::vector<FreeQuantity>& more,
                  const std::vector<double>& begin);

}  // namespace awmr
