/// Plausibility of I'z of a log fit, given m' and the vehicle's size. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_stage.h"

namespace awmr {

/// Refuses an impossible I'z (`inertia-mismatch`). If m' can be the wrong one of the two, as with a
/// wrong unit of the speed, all intervals are withdrawn.
void check_inertia(const Vehicle& vehicle, const std::vector<DrivingLog>& logs, const Model& model,
                   LogStage& stage);

}  // namespace awmr
