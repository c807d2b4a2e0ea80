/// Search for delays, lags and constant errors of sensors and commands in a log fit. Each of these
/// terms is freed if it improves the fit significantly. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {

/// Terms that can still be added to the fit:
///   - a delay of the commands and of every measured channel (one for x and y together). At least
///     one of these signals has no delay, as the time reference of the others;
///   - an additional delay of the steering, if the servo's time constant is free;
///   - a steering trim, if the steering moves;
///   - a force imbalance, if left and right forces differ;
///   - a saturation of the forces, or an exponent below 1;
///   - slip of the wheels that measure the speed, or the yaw rate if left and right forces differ;
///   - place and direction of a sway sensor;
///   - Stribeck friction of a resistance with Coulomb friction; a slope, if heading or position are
///     measured (extra_forces.h).
std::vector<FreeQuantity> further_terms(const LogProblem& problem);

/// Adds the terms of further_terms() one at a time to the converged fit `settled`, until none
/// improves the fit. Score tests select candidates, and one round of settle_noise() ranks them. The
/// best candidate is kept if its final fit lowers AIC by more than 10. (Without these terms,
/// latency of the speed, for example, would bias the mass upwards.)
///   - The delay of the commands is negative if their time stamps are late.
///   - A motor lag is tried in place of the command delay and in addition to it, unless the vehicle
///     file gives the lag. A low-pass filter is tried in place of a delay of the speed, the yaw
///     rate or the heading.
///   - Steering trim and force imbalance have nearly the same effect. If one of them is found and
///     the commands allow both, both are freed.
NoiseIteration find_delays_and_errors(NoiseIteration settled, Loss loss);

}  // namespace awmr
