/// The search for a good point to begin the fit from. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

struct Multistart {
  std::vector<double> coordinates;  ///< of the best search; empty where every search failed
  std::vector<SearchStart> starts;  ///< the initial guess, the other places, the random ones
};

/// Where other trials gave the initial guess: that. Otherwise a rough search from the guess, from
/// each other place given and, where some of the guess is an order of magnitude, from several random
/// ones, on some of the windows; the least cost is taken.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
