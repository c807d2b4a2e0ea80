/// Initial numbers of the interactive part (sliders) of the page. Private to report/.
#pragma once

#include <vector>

#include "awmr/core/json.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Returns LiveSetup (live/setup.h) as numbers; empty if the model has no turning motion. `gains` is
/// gains.json. The page computes the constraints with the conditions in it (`/robust`,
/// `/constraints`, `/limits`, `/examined`). Errors (input): gains.json does not have the format of
/// `awmr tune`.
Result<std::vector<double>> live_numbers(const Model& model, const Json& gains,
                                         const Scenario& scenario);

/// True if the interactive part can run the scenario: it commands headings and has no other effects
/// (sensors, disturbances, ...).
bool is_plain_heading(const Json& scenario);

}  // namespace awmr
