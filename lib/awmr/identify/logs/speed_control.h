/// Detects logs whose force columns are set-points of a speed controller. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_stage.h"

namespace awmr {

/// The warning `speed-controlled`, if each wheel rolls at a speed in proportion to its command:
///   - both fitted resistances are linear and the yaw coefficient is d^2 times the surge
///     coefficient (d: half of the track width):
///
///         tau_speed = a1 u,   tau_turn = a3 r = d^2 a1 r
///
///   - or the intervals of the fit are withdrawn, and the steady speeds of the wheels are in
///     proportion to their commands.
///
/// The cause is motor drag, or a speed controller whose set-points were logged as forces.
std::vector<Finding> speed_control_findings(const Vehicle& vehicle,
                                            const std::vector<DrivingLog>& logs,
                                            const LogStage& stage);

}  // namespace awmr
