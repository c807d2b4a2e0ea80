/// Sensors that are read late, commands that act late or were logged late, motors that lag. Private to
/// identify/.
#pragma once

#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {

/// Frees, one after the other, each delay that a score test suspects and with which the fit is plainly
/// likelier (ten of AIC): a late speed would otherwise pass for a heavy vehicle. A delay of all commands
/// may be negative, where they were logged late; where it is positive, the lag of the motors takes its
/// place if that is likelier. Of the commands and all channels, one stays without a delay: the others
/// are late against it.
NoiseIteration allow_for_delays(NoiseIteration settled, Loss loss);

}  // namespace awmr
