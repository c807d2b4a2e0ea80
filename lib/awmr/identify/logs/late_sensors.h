/// Sensors that are read late. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {

/// Frees the delay of a channel that a score test suspects, where the fit is plainly likelier with it
/// (ten of AIC), until no other channel is late: a late speed would otherwise pass for a heavy
/// vehicle. With an input delay free, which moves all channels alike, it is left alone.
NoiseIteration allow_for_late_sensors(NoiseIteration settled, Loss loss);

}  // namespace awmr
