/// Plausibility check of the yaw inertia I'z from a log fit, by the mass m' and the vehicle's size.
/// Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_stage.h"

namespace awmr {

/// Refuses I'z of the log fit `stage` (gives it no value) in two cases: no distribution of mass
/// within the vehicle's size gives the fitted I'z/m', or m' is not determined and only the steering
/// turns the vehicle. If not I'z but m' may be wrong, for example because of a wrong unit of the
/// speed, also withdraws all intervals and reports `inertia-mismatch`. If I'z/m' is possible but
/// unusual, only reports `inertia-mismatch`. `model`: values from other trials.
void check_inertia(const Vehicle& vehicle, const std::vector<DrivingLog>& logs, const Model& model,
                   LogStage& stage);

}  // namespace awmr
