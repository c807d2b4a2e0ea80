/// Limits that the baseline gains do not meet. Private to tune/.
#pragma once

#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns every requirement of the search that the baseline gains do not meet (Tuning::
/// baseline_violates). `objective`: on all draws, normalised by these gains. `requested`: options
/// whose absent bounds are not filled in.
std::vector<ConstraintReport> violated_by_baseline(const Gains<double>& baseline,
                                                   const Objective& objective,
                                                   const ConstraintContext& context,
                                                   const TuneOptions& requested);

}  // namespace awmr
