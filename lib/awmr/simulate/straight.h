/// Runs of a model that knows straight motion alone.
#pragma once

#include "awmr/core/result.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Errors (input): a run of a model that knows straight motion alone turns; says where, and what
/// turning takes.
Status check_straight(const Run& run, const Scenario& scenario, const Model& model);

}  // namespace awmr
