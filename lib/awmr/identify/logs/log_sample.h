/// Parts of long logs, for searches that need not use all rows. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// Number of windows of 10 s in a sample. Logs with less than twice as many are used entirely.
inline constexpr std::size_t kSampleWindows = 12;

/// True if a sample is much shorter than the logs: at least 2 kSampleWindows windows.
bool is_long(const LogProblem& problem);

/// Indices of `count` of `size` elements, evenly spaced; of all elements if there are fewer.
std::vector<std::size_t> spread(std::size_t size, std::size_t count);

/// Returns the problem with these windows only, and without the channels that they do not contain.
LogProblem with_windows(const LogProblem& problem, const std::vector<std::size_t>& windows);

/// Returns the point with the initial states of these windows only. `problem`: that of `point`.
SearchPoint with_windows(const LogProblem& problem, const SearchPoint& point,
                         const std::vector<std::size_t>& windows);

}  // namespace awmr
