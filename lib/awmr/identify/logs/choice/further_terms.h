/// Delays, lags and constant errors of sensors and commands that a log fit can add, because score
/// tests indicate them or because the user requested them. Private to identify/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/identify/logs/problem/log_problem.h"

namespace awmr {

/// Terms that the fit does not contain yet and that the logs can show:
///   - a delay of the commands and of every measured channel (one for x and y together). At least
///     one of these signals keeps the delay 0, because the delays of all signals are relative to
///     it;
///   - symmetric smoothing of the channels that are often filtered, unless a filter or smoothing is
///     already estimated;
///   - an additional delay of the steering, if the servo's time constant is free;
///   - a steering trim, if the steering moves;
///   - a dead band, an asymmetry and a curve of the steering, if it moves by logged commands;
///   - the scale of the steering angles, if the fit has such an asymmetry or curve;
///   - a force imbalance, if left and right forces differ; with a dead zone of the motors, also the
///     difference between their dead zones;
///   - a saturation or an exponent of the forces, or a supply sag if left and right forces differ;
///   - ramps by which the forces rise or fall;
///   - forces of extra_forces.h (add_forces() in further_terms.cpp);
///   - a scale error of the yaw rate if the heading or a position is measured, and of the speed if
///     a position is measured;
///   - slip of the wheels that measure the speed or, if left and right forces differ, the yaw rate,
///     unless an excess of wheel forces is estimated (wheel_slip.h does not include it);
///   - position and direction of a sensor of the sideways (sway) speed;
///   - the deviation of a compass, if the heading is measured.
std::vector<FreeQuantity> further_terms(const LogProblem& problem);

/// True for channels that programs often filter before logging: speed, yaw rate and heading.
bool is_often_filtered(LogChannel channel);

/// True for channels that programs often compute from counts of encoders: speed and yaw rate.
bool is_often_counted(LogChannel channel);

/// The terms that the user requested by these names (IdentifyOptions::terms), with initial guesses.
/// Ignores names that are not requestable_terms().
std::vector<FreeTerm> requested_terms(std::span<const std::string> names);

}  // namespace awmr
