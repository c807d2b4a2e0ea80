/// The delays, lags and constant errors of sensors and commands that a log fit can add. Private to
/// identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// Terms that can still be added to the fit:
///   - a delay of the commands and of every measured channel (one for x and y together). At least
///     one of these signals has no delay, as the time reference of the others;
///   - symmetric smoothing of the channels that are often filtered, unless a filter or smoothing is
///     estimated;
///   - an additional delay of the steering, if the servo's time constant is free;
///   - a steering trim, if the steering moves;
///   - a force imbalance, if left and right forces differ;
///   - a saturation of the forces, or an exponent below 1;
///   - slip of the wheels that measure the speed, or the yaw rate if left and right forces differ;
///   - place and direction of a sway sensor;
///   - Stribeck friction of a resistance with Coulomb friction; a slope, if heading or position are
///     measured (extra_forces.h).
std::vector<FreeQuantity> further_terms(const LogProblem& problem);

/// True for channels that are often filtered before logging: speed, yaw rate and heading.
bool is_often_filtered(LogChannel channel);

}  // namespace awmr
