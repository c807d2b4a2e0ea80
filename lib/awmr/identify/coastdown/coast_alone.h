/// Fit of coast-down curves without a surge law, and parts common to all reports on curves. Private
/// to identify/coastdown/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/coastdown/mass.h"

namespace awmr {

/// Rows, scatter, rank, and the tests of each run's residuals.
void add_curve_figures(EstimatorReport& report, const CoastFit& fit);

/// Estimate of a number from that of its logarithm, with standard error and interval; `half`: the t
/// quantile.
EstimatorParameter by_logarithm(std::string name, double value, double error, double half);

/// Estimates m'/a1 and the terms of the law relative to a1 from the curves alone, by the requested
/// family, or the one with the minimum AICc for `auto`. Gives the reason why m' itself is not
/// identified.
MassResult without_surge(const std::vector<CoastCurve>& curves, const Vehicle& vehicle,
                         const FamilyChoice& family, MassResult result);

}  // namespace awmr
