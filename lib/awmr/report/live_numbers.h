/// The numbers that the live part of the page starts from. Private to this folder.
#pragma once

#include <vector>

#include "awmr/core/json.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// The setup of live/setup.h as the numbers that it is read back from; empty where the model does
/// not know of turning. `gains` is gains.json: under what it was tuned (/robust, /constraints) its
/// constraints are worked out again.
/// Errors (input): gains.json does not say that as tune writes it.
Result<std::vector<double>> live_numbers(const Model& model, const Json& gains,
                                         const Scenario& scenario);

/// A scenario that the live part can run: headings to hold, and nothing else that acts.
bool is_plain_heading(const Json& scenario);

}  // namespace awmr
