/// Least-squares solution of a LogProblem by Ceres. Private to identify/.
#pragma once

#include <limits>
#include <string>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

struct Solved {
  SearchPoint point;  ///< end of the search
  double cost = std::numeric_limits<double>::infinity();
  bool converged = false;
  bool usable = false;  ///< the cost is not above that of the start
  std::string stop_reason;
};

/// Levenberg-Marquardt within the bounds, each window's initial state eliminated. Ends when a step
/// changes the cost by less than this relative amount.
Solved solve(const LogProblem& problem, SearchPoint from, double function_tolerance);

}  // namespace awmr
