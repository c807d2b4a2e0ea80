/// Influence of each run on a table fit, measured by repeating the fit without the run. Private to
/// identify/.
#pragma once

#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

struct Influence {
  /// One entry per run: parameter values of the fit without this run. No entry if that fit fails.
  std::vector<LeaveOneOut> without;
  /// The finding `influential-row` for each run whose omission changes a parameter by more than one
  /// standard error.
  std::vector<Finding> findings;
};

/// Fits the curve without each run in turn: by log-linear least squares if `log_linear`, else by
/// the method of `problem`, starting at the optimum `fit` of all runs. If there are more than
/// kExactRows rows, one Gauss-Newton step from `fit` replaces each fit without a run, because these
/// fits would take too long. The step is exact for log-linear fits, and not available with a robust
/// loss: the result is then empty. Precondition: at least two degrees of freedom, so that one
/// remains without a run.
Influence leave_one_out(const Subject& subject, const SteadyProblem& problem, bool log_linear,
                        const SteadyFit& fit);

/// True if the runs have at least two different forces. A curve cannot be fitted to fewer.
bool has_two_forces(const std::vector<SteadyPoint>& points);

}  // namespace awmr
