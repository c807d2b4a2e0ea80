/// Multistart search for initial guesses. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

struct Multistart {
  /// Coordinates at the ends of the searches with a usable solution, smallest cost first.
  std::vector<std::vector<double>> ends;
  std::vector<SearchStart> starts;  ///< the initial guess, the other ones, the random ones
};

/// Returns the initial guess if it is complete from other trials and no other one is given.
/// Otherwise runs rough searches from the guess, from each other one and, if some of the guess is
/// only an order of magnitude, from several random ones. The searches use short parts of some of
/// the windows, because over a long part the effect of a wrong guess accumulates and the search
/// ends in a wrong optimum.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
