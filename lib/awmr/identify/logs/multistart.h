/// The search for a good point to begin the fit from. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

struct Multistart {
  /// Coordinates where the searches ended that led anywhere, the least cost first.
  std::vector<std::vector<double>> ends;
  std::vector<SearchStart> starts;  ///< the initial guess, the other places, the random ones
};

/// Where other trials gave the initial guess: that. Otherwise a rough search from the guess, from
/// each other place given and, where some of the guess is an order of magnitude, from several random
/// ones, on short parts of some of the windows: over a long one, what a wrong guess does adds up, and
/// the search ends where the motion is nothing like the log.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
