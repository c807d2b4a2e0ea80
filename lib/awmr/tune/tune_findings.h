/// Findings (notes and warnings) of a tuning, for the output of `awmr tune`.
#pragma once

#include <vector>

#include "awmr/model/record.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns all findings of a tuning: first those from newly drawn vehicles, then all others. For
/// nominal gains, or without newly drawn vehicles, the runs of the nominal vehicle are used
/// instead. Preconditions: `tuning` is the result of tune() with `options`, and options.scenarios
/// has all scenarios of the tuning, including default scenarios (for the findings
/// `observer-unpushed` and `beyond-trials`).
std::vector<Finding> tune_findings(const Model& model, const TuneOptions& options,
                                   const Tuning& tuning);

}  // namespace awmr
