/// Checks of a fit of steady runs: active bounds, residuals that violate the method's assumptions,
/// influential runs. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

/// `no-degrees-of-freedom`, `exponent-at-bound`, `term-at-zero`.
/// Error `exponent-at-bound`: why a fit with its exponent at a bound gives no value, and the range
/// to set.
Finding held_exponent(const Subject& subject, const SteadyFit& fit);

std::vector<Finding> bound_findings(const Subject& subject, const SteadyFit& fit, Family family);

/// Tests of the residuals for normality, curvature and lack of fit, as far as the number of runs
/// allows. Precondition: degrees of freedom.
std::vector<Diagnostic> residual_tests(const Subject& subject, const SteadyFit& fit);

/// `outlier`: runs that deviate from the curve of the others, by Student's t at 5 % for the whole
/// table (Bonferroni). The times of timed runs have to deviate as well: equal errors of a stop-watch
/// are unequal shares of the speed, so that the fastest run looks like an outlier.
std::vector<Finding> outlier_findings(const Subject& subject, const SteadyProblem& problem,
                                      const SteadyFit& fit);

}  // namespace awmr
