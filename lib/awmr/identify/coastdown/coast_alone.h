/// Coast-down curves without a surge law, and what reports on curves have in common. Private to
/// identify/coastdown/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/coastdown/mass.h"

namespace awmr {

/// Rows, scatter, rank, and the tests of each run's residuals.
void add_curve_figures(EstimatorReport& report, const CoastFit& fit);

/// A number known by its logarithm: its standard error and interval, `half` the t quantile.
EstimatorParameter by_logarithm(std::string name, double value, double error, double half);

/// Estimates m' and the law's terms over a1 from the curves alone, by the requested family, or the one of
/// minimum AICc for `auto`, and the reason why m' itself is not identified.
MassResult without_surge(const std::vector<CoastCurve>& curves, const Vehicle& vehicle,
                         const FamilyChoice& family, MassResult result);

}  // namespace awmr
