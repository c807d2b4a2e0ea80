/// The rows of the trial tables, each with the model's prediction, for model.json. Private to
/// identify/.
#pragma once

#include <vector>

#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// Lists the rows of the surge, turning and stop-time tables with the model's prediction of the
/// steady speed, the steady yaw rate or the stop time. A row gets no prediction if the model lacks
/// a parameter for it. Omits turning rows whose wheel forces are within the dead zone, that is, too
/// small to move the wheels.
std::vector<TrialPoint> trials_as_used(const TrialData& data, const Model& model);

}  // namespace awmr
