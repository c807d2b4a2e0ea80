/// Decides which values of a log count as measurements, and reports problems of its channels and
/// commands. Private to trials/.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Minimum number of rows of a run in a log.
inline constexpr std::size_t kShortestLog = 10;

/// Builds a channel. `values`: one per row, SI. `rows`: the rows in which the file has a value.
/// Some files write a value only when it has changed, at irregular times (resolution_of_changes()).
/// In such a file, each row between the first and the last of these values counts as a measurement
/// of the last value before it. Findings: `only-changes`, `spikes`, `stuck-sensor`,
/// `saturated-channel`, `quantised-samples`. Precondition: the log has its times and commands.
Measured measured_of(LogChannel channel, const DrivingLog& log,
                     const std::vector<std::size_t>& rows, std::vector<double> values,
                     std::vector<Finding>& findings);

/// Marks both x and y of a row as measurements if x or y changed, because a position receiver
/// updates both together. No effect if x and y are as fast as the log.
void join_position(DrivingLog& log);

/// Adds the note `held-samples` for each channel that is slower than the log.
void note_held(const DrivingLog& log, std::vector<Finding>& findings);

/// Adds the warning `command-held` if the command `column` gets no new value for a second or more,
/// and for more than ten times its mean interval. The log then repeats the old command, although
/// the vehicle may have stopped. `rows`: the rows in which the file has a value. Adds nothing if
/// these are all rows.
void note_stale_command(std::string_view column, const DrivingLog& log,
                        const std::vector<std::size_t>& rows, std::vector<Finding>& findings);

/// Adds the note `log-gap` for each time step of more than kGapSteps median steps.
void note_gaps(const DrivingLog& log, std::vector<Finding>& findings);

}  // namespace awmr
