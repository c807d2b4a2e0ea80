/// Selection of a part of long logs, for searches that need not use all rows. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// Number of windows (10 s each) in a sample of long logs. Logs with less than twice as many
/// windows are used entirely.
inline constexpr std::size_t kSampleWindows = 12;

/// True if the logs have so many windows, at least 2 kSampleWindows, that a sample of them saves
/// time.
bool is_long(const LogProblem& problem);

/// Returns `count` evenly spaced indices out of `size`; all indices if `size` is smaller than
/// `count`.
std::vector<std::size_t> spread(std::size_t size, std::size_t count);

/// Returns the problem with only the windows that have these indices. Channels without samples in
/// them are left out.
LogProblem with_windows(const LogProblem& problem, const std::vector<std::size_t>& windows);

/// Returns the point with only the initial states of the windows that have these indices.
/// `problem`: the problem to which `point` belongs.
SearchPoint with_windows(const LogProblem& problem, const SearchPoint& point,
                         const std::vector<std::size_t>& windows);

}  // namespace awmr
