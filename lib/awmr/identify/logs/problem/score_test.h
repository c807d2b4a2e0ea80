/// Rao score test: predicts from a fit whether one more parameter would improve it, without a new
/// fit. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/problem/log_problem.h"

namespace awmr {

struct ScoreTest {
  double value = 0.0;  ///< estimate of the candidate by one Gauss-Newton step from 0
  /// Standard error of `value`: the larger of two estimates, one from the noise model and one from
  /// the scatter between blocks of the logs.
  double std_error = 0.0;
  double noise_error = 0.0;  ///< standard error of `value` by the noise model
  double gain = 0.0;         ///< estimated decrease of -2 ln L: (value / std_error)^2
};

/// Tests whether a candidate quantity improves the fit, by Rao's score test of the hypothesis that
/// its value is 0. Each candidate has its own test: all quantities of the problem are free, and the
/// other candidates are 0. H is the information matrix, and g the gradient of -ln L with respect to
/// the coordinates, at the solution without the candidate. The index t stands for the coordinates
/// of the problem, c for that of the candidate:
///
///     value = -(g_c - H_ct H_tt^-1 g_t) / (H_cc - H_ct H_tt^-1 H_tc)
///
/// The test uses the noise model of with_white_noise(), because a noise model with drift could
/// absorb the effect of a candidate. `point`: the solution without the candidates. All numbers of a
/// result are 0 if the data contain no information about the candidate, or if the simulation is not
/// finite. Precondition: the coordinate of each candidate is its value, not a logarithm.
std::vector<ScoreTest> score_test(const LogProblem& problem, const SearchPoint& point,
                                  const std::vector<FreeQuantity>& candidates);

/// Replaces the drift of every channel by white noise of the same variance. Slow errors then
/// increase the cost, in place of being explained as drift.
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
