/// Multistart search for initial guesses. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

/// Result of multistart().
struct Multistart {
  /// Coordinates at the ends of the searches with a usable solution, smallest cost first.
  std::vector<std::vector<double>> ends;
  /// Report of all starts: the initial guess, LogFitOptions::also_from, the random guesses.
  std::vector<SearchStart> starts;
};

/// Problem of rough searches: up to twelve parts of 2.5 s, spread over all logs, with longer
/// integration steps.
LogProblem rough_problem(const LogProblem& problem);

/// Relative change of the cost at which rough searches end.
inline constexpr double kRough = 1e-4;

/// Searches for initial guesses. If other trials gave the whole initial guess and `also_from` is
/// empty, returns only that guess, without a search. Otherwise runs rough searches from the initial
/// guess and from each guess in `also_from`. If some parameters have only a guess of their order of
/// magnitude, also searches from random guesses. The searches use short parts of some windows: over
/// a long part, the effect of a wrong guess accumulates, and the search ends in a wrong optimum. If
/// no search is usable, `ends` is empty.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
