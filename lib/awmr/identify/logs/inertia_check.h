/// I'z of a fit of logs against m' and the vehicle's size. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_stage.h"

namespace awmr {

/// Refuses an I'z that the vehicle cannot have. Where m' may be the wrong one of the two, as with a speed
/// in another unit, no interval is left (`inertia-mismatch`).
void check_inertia(const Vehicle& vehicle, const std::vector<DrivingLog>& logs, const Model& model,
                   LogStage& stage);

}  // namespace awmr
