/// What counts as measured in a log, and what is told of its channels and commands. Private to this
/// folder.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Fewer rows are no log.
inline constexpr std::size_t kShortestLog = 10;

/// A channel from its values by row, SI; `rows` are those in which it has a reading. The log's times
/// and commands have to be there. Findings: `spikes`, `stuck-sensor`, `saturated-channel`,
/// `quantised-samples`.
Measured measured_of(LogChannel channel, const DrivingLog& log,
                     const std::vector<std::size_t>& rows, std::vector<double> values,
                     std::vector<Finding>& findings);

/// A receiver gives x and y together: a repeat of one alone is chance.
void join_position(DrivingLog& log);

/// Finding `held-samples`: channels slower than the log.
void note_held(const DrivingLog& log, std::vector<Finding>& findings);

/// Finding `command-held`: a command that came in `rows` only and was not renewed for long may have
/// ended.
void note_stale_command(std::string_view column, const DrivingLog& log,
                        const std::vector<std::size_t>& rows, std::vector<Finding>& findings);

/// Finding `log-gap`: nothing was logged for long.
void note_gaps(const DrivingLog& log, std::vector<Finding>& findings);

}  // namespace awmr
