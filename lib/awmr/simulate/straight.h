/// Checks that a run does not turn, for models that only have parameters for straight motion.
#pragma once

#include "awmr/core/result.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Checks that the vehicle drives straight in this run. Errors (input): the run turns, or moves
/// sideways. The message has the time and the parameters that the model lacks. Precondition: the
/// model only has parameters for straight motion.
Status check_straight(const Run& run, const Scenario& scenario, const Model& model);

}  // namespace awmr
