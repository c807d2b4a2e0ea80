/// Checks that a run with a model for straight motion does not turn.
#pragma once

#include "awmr/core/result.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Errors (input): the run turns, but the model only has parameters for straight motion. The message
/// has the time and the missing parameters.
Status check_straight(const Run& run, const Scenario& scenario, const Model& model);

}  // namespace awmr
