/// Determines whether a driving log begins at rest or in motion, and adds a row of rest before a
/// log that begins at rest.
#pragma once

#include "awmr/trials/log.h"

namespace awmr {

/// Largest magnitude of the measurements of a channel, SI; 0 without any.
double largest_measured(const DrivingLog& log, LogChannel channel);

/// True if the vehicle already moves at the first row: the median of the first five readings of
/// speed or yaw rate is above 5 % of the largest reading.
bool begins_in_motion(const DrivingLog& log);

/// In a log that begins at rest with motors switched on, adds a row one median time step before the
/// first one, without forces and without measurements. No force acted before the log, because the
/// vehicle would have moved. Without this row, lagged or delayed forces would be simulated as if
/// the first command had been constant before the log. Does nothing in a log without a speed.
void add_row_of_rest(DrivingLog& log);

}  // namespace awmr
