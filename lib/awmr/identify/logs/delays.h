/// Selection of timing and command-error terms of a log fit: latency and filters of sensors,
/// latency of commands or their time stamps, dead time and trim of the steering, lag and imbalance
/// of the motors. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {

/// Terms that can be added to the fit:
///   - a delay of the commands and of every measured channel without one (x and y have a common
///     one), as long as two or more lack a delay;
///   - an additional delay of the steering, if the servo's time constant is free;
///   - a steering trim, if the steering moves, and a force imbalance, if left and right forces
///     differ; otherwise each would be a constant moment.
std::vector<FreeQuantity> further_terms(const LogProblem& problem);

/// Frees such terms one at a time. A score test selects candidates; the one that lowers AIC most
/// after one round of its fit is kept if the final fit lowers AIC by more than 10. Without these
/// terms, latency of the speed would bias the mass upwards.
///   - The delay of all commands is negative if they were logged late.
///   - Motor lag replaces that delay, or is freed with it, if that is likelier and the vehicle
///     file does not give the lag. In the same way, a filter replaces a delay of speed or yaw rate.
///   - A dead time of the steering alone would otherwise be estimated as a slow servo.
///   - Of the commands and all channels, one has no delay: it is the time reference.
///   - Trim and imbalance have nearly the same effect; if both can be added, they are freed
///     together.
NoiseIteration find_delays_and_errors(NoiseIteration settled, Loss loss);

}  // namespace awmr
