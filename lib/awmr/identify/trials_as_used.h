/// Measured rows of the tables with their predictions, for the model file. Private to identify/.
#pragma once

#include <vector>

#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// Lists every row of the tables with the model's prediction. Rows whose parameters have no value
/// get no prediction.
std::vector<TrialPoint> trials_as_used(const TrialData& data, const Model& model);

}  // namespace awmr
