/// Limits that the baseline gains do not meet. Private to tune/.
#pragma once

#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns every requirement of the search that the baseline gains do not meet: constraints,
/// requested bounds, activity limit and goals that are not soft. `objective`: the objective on the
/// nominal vehicle and all drawn vehicles, normalised by the baseline gains. `requested`: the
/// options as the user gave them, so that default bounds of the gains do not count.
std::vector<ConstraintReport> violated_by_baseline(const Gains<double>& baseline,
                                                   const Objective& objective,
                                                   const ConstraintContext& context,
                                                   const TuneOptions& requested);

}  // namespace awmr
