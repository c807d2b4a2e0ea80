/// Latency and filters of sensors, latency of commands or of their time stamps, dead time and trim of
/// the steering, lag and imbalance of the motors. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {

/// A delay of the commands and of every measured channel, one for both coordinates of the position,
/// where they have none yet; none where all but one have. One of the steering alone. The steering's
/// trim and the imbalance of the forces, where the commands separate them from a constant moment.
std::vector<FreeQuantity> further_terms(const LogProblem& problem);

/// Frees such terms one after the other: of the candidates of a score test, the one that lowers AIC
/// most after one round of its fit, if it lowers it by more than ten in the end. Without it,
/// latency of the speed would bias the mass upwards. A delay of all commands may be negative, where
/// they were logged late. The lag of the motors takes its place, or becomes free together with it,
/// where that is likelier (unless the vehicle file gives that lag); in the same way a filter takes
/// the place of a late speed or yaw rate. The steering alone may be later than the forces: a dead
/// time that would pass for a slow servo. Of the commands and all channels, one stays without a
/// delay: the others are late against it. A steering trim needs steering that moves, an imbalance
/// of the motors needs forces that differ: otherwise each is a constant moment. Where
/// the commands show both, they become free together.
NoiseIteration find_delays_and_errors(NoiseIteration settled, Loss loss);

}  // namespace awmr
