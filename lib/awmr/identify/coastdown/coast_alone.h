/// Fit of coast-down curves without a surge law, and helpers for the reports of all curve fits.
/// Private to identify/coastdown/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/coastdown/mass.h"

namespace awmr {

/// Writes the statistics of a curve fit into its report: number of rows, residual standard
/// deviation, degrees of freedom, rank, condition number, stop reason and residual tests.
void add_curve_figures(EstimatorReport& report, const CoastFit& fit);

/// Entry in /estimates of model.json for a positive number whose logarithm was fitted. `value`: the
/// number itself. `error`: standard error of the logarithm. `half`: half width of the logarithm's
/// 95 % interval in standard errors (quantile of Student's t).
EstimatorParameter by_logarithm(std::string name, double value, double error, double half);

/// Estimates m'/a1 and, if the resistance family has these terms, the exponent b1, c1/a1 (Coulomb)
/// and q1/a1 (quadratic) from coast-down curves alone. Uses the requested family (for `auto`: the
/// one with the smallest AICc), or the power law if none is requested. Returns `result` with these
/// values and with the reason why m' itself is not identified. If there are no curves, or no fit of
/// them is usable, it adds only the reason.
MassResult without_surge(const std::vector<CoastCurve>& curves, const Vehicle& vehicle,
                         const FamilyChoice& family, MassResult result);

}  // namespace awmr
