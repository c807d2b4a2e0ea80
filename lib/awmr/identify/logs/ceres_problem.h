/// Solution of a LogProblem by Ceres. Private to identify/.
#pragma once

#include <limits>
#include <string>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// Result of solve().
struct Solved {
  SearchPoint point;  ///< point where the search ended, converged or not
  double cost = std::numeric_limits<double>::infinity();
  bool converged = false;
  bool usable = false;  ///< true: the solver did not fail and did not increase the cost
  std::string stop_reason;
};

/// Minimises the cost by Levenberg-Marquardt steps within the bounds, starting at `from`. Each step
/// eliminates the initial states of the windows from its linear system. The search converges when a
/// step changes the cost by less than the fraction `function_tolerance` of the cost, or when
/// further steps would not help (EndWithoutProgress in ceres_problem.cpp). It ends without
/// convergence after 60 steps, at the limit of work (Effort) or at the deadline.
Solved solve(const LogProblem& problem, SearchPoint from, double function_tolerance);

}  // namespace awmr
