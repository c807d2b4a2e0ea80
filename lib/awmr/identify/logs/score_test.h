/// Rao score test for adding one parameter to a fit. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// Result of a score test.
struct ScoreTest {
  double value = 0.0;  ///< estimate of the candidate by one Gauss-Newton step from 0
  /// Standard error of `value`: the larger one of those by the noise model and by the scatter of
  /// blocks.
  double std_error = 0.0;
  double noise_error = 0.0;  ///< standard error of `value` by the noise model
  double gain = 0.0;         ///< estimated decrease of -2 ln L: (value / std_error)^2
};

/// Tests whether a candidate quantity improves the fit, by Rao's score test of the hypothesis that
/// its value is 0. Each candidate is tested alone: all quantities of the problem are free, and the
/// other candidates are fixed at 0. H is the information and g the gradient; t are the coordinates
/// of the problem and c is that of the candidate:
///
///     value = -(g_c - H_ct H_tt^-1 g_t) / (H_cc - H_ct H_tt^-1 H_tc)
///
/// The noise model is replaced by with_white_noise(), so that drift cannot absorb the effect of a
/// candidate. `point`: the solution without the candidates. All numbers of a result are 0 if the
/// data contain no information about the candidate, or if the simulation is not finite.
/// Precondition: the coordinate of each candidate is its value, not a logarithm.
std::vector<ScoreTest> score_test(const LogProblem& problem, const SearchPoint& point,
                                  const std::vector<FreeQuantity>& candidates);

/// Returns the problem with the drift of every channel replaced by white noise, so that slow errors
/// count against the model. The total variance of each channel's noise stays the same.
LogProblem with_white_noise(LogProblem problem);

/// A problem with additional free quantities, and a point with the coordinates of all of them.
struct Extended {
  LogProblem problem;
  SearchPoint point;
};
/// Adds the free quantities `more` to the problem, with the initial guesses `begin`.
Extended extended(LogProblem problem, SearchPoint point, const std::vector<FreeQuantity>& more,
                  const std::vector<double>& begin);

}  // namespace awmr
