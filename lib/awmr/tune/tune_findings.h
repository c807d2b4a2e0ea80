/// Findings (notes and warnings) of a tuning, for the output of `awmr tune`.
#pragma once

#include <vector>

#include "awmr/model/record.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// All findings of a tuning: first those of the fresh draws, then those that do not depend on the
/// draws. For nominal gains, or without fresh draws, the runs of the nominal vehicle replace those
/// on fresh draws. Preconditions: `tuning` is the result of tune() with `options`, and
/// options.scenarios has all scenarios of the tuning, including default ones (needed for
/// `observer-unpushed` and `beyond-trials`).
std::vector<Finding> tune_findings(const Model& model, const TuneOptions& options,
                                   const Tuning& tuning);

}  // namespace awmr
