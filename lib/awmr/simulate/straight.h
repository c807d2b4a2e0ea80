/// Check of runs with a model of straight motion.
#pragma once

#include "awmr/core/result.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Errors (input): the model only has straight motion and the run turns; the message has the time
/// and the missing parameters.
Status check_straight(const Run& run, const Scenario& scenario, const Model& model);

}  // namespace awmr
