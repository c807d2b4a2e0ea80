/// Checks of a table fit: parameters at bounds, residuals that violate the method's assumptions,
/// outliers. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

/// The error `exponent-at-bound`, with the remedy. Precondition: the search for the exponent ended
/// at a limit of its accepted range.
Finding held_exponent(const Subject& subject, const SteadyFit& fit);

/// These findings, where they apply: the warning `no-degrees-of-freedom` (as many parameters as
/// runs), the warning `exponent-at-bound` (the exponent of a log-linear fit is outside its range),
/// and the note `term-at-zero` for each term whose fitted value is 0.
std::vector<Finding> bound_findings(const Subject& subject, const SteadyFit& fit, Family family);

/// Tests the residuals for normality, curvature and lack of fit. Skips a test if there are too few
/// runs for it. Precondition: the fit has degrees of freedom.
std::vector<Diagnostic> residual_tests(const Subject& subject, const SteadyFit& fit);

/// The warning `outlier` for each run that deviates significantly from the curve of the other runs:
/// Student's t, 5 % for the whole table (Bonferroni). If the runs were timed, the time of the run
/// must deviate significantly as well. By its force alone, the fastest run could look like an
/// outlier, because a stop-watch error is a larger share of its short time.
std::vector<Finding> outlier_findings(const Subject& subject, const SteadyProblem& problem,
                                      const SteadyFit& fit);

}  // namespace awmr
