/// Determines whether a driving log begins at rest or in motion, and adds a row of rest before a
/// log that begins at rest.
#pragma once

#include "awmr/trials/log.h"

namespace awmr {

/// Largest magnitude of the measurements of a channel, SI; 0 without any.
double largest_measured(const DrivingLog& log, LogChannel channel);

/// True if the vehicle already moves at the first row. Criterion: of the first five readings of
/// speed or yaw rate, the median and a straight line's value at the first row are both above 5 % of
/// the largest reading. Without the line, a fast start from rest would count as motion.
bool begins_in_motion(const DrivingLog& log);

/// If the log begins at rest and its first row commands a force, adds a row with forces 0 and
/// without measurements, one median time step before the first row. Without this row, a simulation
/// with motor lag or command delay would assume that the first command already acted before the log
/// began, although the vehicle was at rest. No effect in a log without a speed.
void add_row_of_rest(DrivingLog& log);

/// True if the log begins with such a row: without forces and measurements, before a row with a
/// force.
bool has_row_of_rest(const DrivingLog& log);

}  // namespace awmr
