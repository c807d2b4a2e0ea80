/// Leave-one-out influence of runs on a fit. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

struct Influence {
  std::vector<LeaveOneOut> without;  ///< by run; those whose rest shows no curve are left out
  std::vector<Finding> findings;     ///< `influential-row`: a parameter moves by a standard error
};

/// Every run left out once, the curve fitted to the others by the same method: through the
/// logarithms where `log_linear`, else as `problem` from the whole fit. Above kExactRows by one step
/// from the whole fit, exact for a log-linear one; there not under a robust loss.
/// Precondition: two degrees of freedom, so that the others have one.
Influence leave_one_out(const Subject& subject, const SteadyProblem& problem, bool log_linear,
                        const SteadyFit& fit);

/// A curve needs two different forces: repeats of one show scatter, no shape.
bool has_two_forces(const std::vector<SteadyPoint>& points);

}  // namespace awmr
