/// Detects which values of a log are measurements, and reports problems of channels and commands.
/// Private to this folder.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Minimum number of rows of a log.
inline constexpr std::size_t kShortestLog = 10;

/// Builds a channel from its values by row, SI; `rows` are those with a reading. The log's times
/// and commands must be set. Findings: `spikes`, `stuck-sensor`, `saturated-channel`,
/// `quantised-samples`.
Measured measured_of(LogChannel channel, const DrivingLog& log,
                     const std::vector<std::size_t>& rows, std::vector<double> values,
                     std::vector<Finding>& findings);

/// A receiver updates x and y together, so if only one of them repeats, both readings are new.
void join_position(DrivingLog& log);

/// Adds finding `held-samples`: channels slower than the log.
void note_held(const DrivingLog& log, std::vector<Finding>& findings);

/// Adds finding `command-held`: a command with values only in `rows` that was not renewed for long
/// and may have ended.
void note_stale_command(std::string_view column, const DrivingLog& log,
                        const std::vector<std::size_t>& rows, std::vector<Finding>& findings);

/// Adds finding `log-gap`: no rows for a long time.
void note_gaps(const DrivingLog& log, std::vector<Finding>& findings);

}  // namespace awmr
