/// Initial data of the page's interactive part (the sliders). Private to report/.
#pragma once

#include <vector>

#include "awmr/core/json/json.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Returns LiveSetup (live/setup.h) as a list of numbers; empty if the model cannot simulate turns.
/// `gains`: content of gains.json, whose keys `/robust`, `/constraints`, `/limits` and `/examined`
/// have the settings for the constraints of `awmr tune`. Precondition: the scenario commands
/// headings. Errors (input): gains.json does not have the format of `awmr tune`; its latency is
/// more than 20 sample times. Also the errors of vehicles_of() (tune/robust.h).
Result<std::vector<double>> live_numbers(const Model& model, const Json& gains,
                                         const Scenario& scenario);

/// True if the interactive part can simulate the scenario (content of a scenario file): it commands
/// headings and has no keys for other effects (sensors, disturbances, obstacles, ...).
bool is_plain_heading(const Json& scenario);

}  // namespace awmr
