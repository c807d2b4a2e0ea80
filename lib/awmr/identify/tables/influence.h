/// Leave-one-out influence of runs on a fit. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

struct Influence {
  std::vector<LeaveOneOut> without;  ///< by run; without runs whose removal leaves no curve
  std::vector<Finding> findings;     ///< `influential-row`: a parameter changes by a standard error
};

/// Fits the curve without each run in turn, by the same method: log-linear if `log_linear`, else
/// `problem` from the optimum of all runs. With more than kExactRows rows, by one step from that
/// optimum, which is exact for log-linear fits; then not available under a robust loss.
/// Precondition: two degrees of freedom, so that one remains without a run.
Influence leave_one_out(const Subject& subject, const SteadyProblem& problem, bool log_linear,
                        const SteadyFit& fit);

/// True if the runs have two different forces, without which no curve can be fitted.
bool has_two_forces(const std::vector<SteadyPoint>& points);

}  // namespace awmr
