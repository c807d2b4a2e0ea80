/// Rows of the tables as used in the identification. Private to identify/.
#pragma once

#include <vector>

#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// Every row of the tables with its prediction by the model's main values, where possible.
std::vector<TrialPoint> trials_as_used(const TrialData& data, const Model& model);

}  // namespace awmr
