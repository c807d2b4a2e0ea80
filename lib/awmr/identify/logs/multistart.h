/// The search for a good point to begin the fit from. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

struct Multistart {
  /// End points of the searches that converged or stopped at a finite cost, smallest cost first.
  std::vector<std::vector<double>> ends;
  std::vector<SearchStart> starts;  ///< the initial guess, the other places, the random ones
};

/// Uses the initial guess of other trials if there is one. Otherwise makes a rough search from the
/// guess, from each other place given and, where some of the guess is an order of magnitude, from
/// several random ones, on short parts of some of the windows: over a long one, the effect of a
/// wrong guess accumulates, and the search ends where the motion is nothing like the log.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
