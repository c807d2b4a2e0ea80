/// The search for a good point to begin the fit from. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

struct Multistart {
  /// Coordinates at the ends of the searches with a usable solution, smallest cost first.
  std::vector<std::vector<double>> ends;
  std::vector<SearchStart> starts;  ///< the initial guess, the other places, the random ones
};

/// Returns the initial guess if other trials gave all of it and no other place is given. Otherwise
/// makes a rough search from the guess, from each other place and, where some of the guess is an
/// order of magnitude, from several random ones. The searches use short parts of some of the
/// windows: over a long part the effect of a wrong guess accumulates, and the search ends where the
/// motion is nothing like the log.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
