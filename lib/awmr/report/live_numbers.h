/// Initial numbers of the interactive part of the page. Private to this folder.
#pragma once

#include <vector>

#include "awmr/core/json.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// The setup of live/setup.h as numbers; empty if the model has no turning motion. `gains` is
/// gains.json: its constraints are computed again under its tuning conditions (/robust,
/// /constraints).
/// Errors (input): gains.json does not have the format of tune.
Result<std::vector<double>> live_numbers(const Model& model, const Json& gains,
                                         const Scenario& scenario);

/// True for a scenario that the interactive part can run: headings to hold, without any other
/// effect.
bool is_plain_heading(const Json& scenario);

}  // namespace awmr
