/// Writes and reads recovery.csv, the estimates of all runs. Private to identify/planning/.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// Largest accepted magnitude of an estimate. The sum of a million squares is then finite.
inline constexpr double kLargestEstimate = 1e150;

/// Text of recovery.csv. It has one row per run with the columns `run,refused`, and
/// `NAME,NAME.std_error,NAME.ci95_lo,NAME.ci95_hi` for every parameter that at least one run has
/// estimated. A cell is empty if the row's run has not estimated the parameter.
std::string recover_csv(const RecoverPart& part);

/// Reads a text written by recover_csv(). The estimates of each run are in the order of `truths`.
/// `file`: file name for errors. Errors (input), with the line: text that is not such a table.
Result<std::vector<RecoverRun>> recover_runs(std::string_view text, const std::string& file,
                                             const std::vector<RecoverTruth>& truths);

}  // namespace awmr
