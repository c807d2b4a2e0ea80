/// The search for a good point to begin the fit from. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

struct Multistart {
  std::vector<double> coordinates;  ///< of the best search; empty where every search failed
  std::vector<SearchStart> starts;  ///< the initial guess, then the random ones
};

/// Where other trials gave the initial guess: that. Where some of it is guessed: one rough search
/// from the guess and several from random ones, on some of the windows; the least cost is taken.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
