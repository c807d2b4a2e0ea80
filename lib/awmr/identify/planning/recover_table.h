/// Writes and reads recovery.csv. Private to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// Upper bound of an estimate, with which the sum of a million squares is finite.
inline constexpr double kLargestEstimate = 1e150;

/// The text of recovery.csv, one row per run: `run,refused`, and
/// `NAME,NAME.std_error,NAME.ci95_lo,NAME.ci95_hi` for every parameter that at least one run
/// estimated. Cells are empty if this run did not estimate it.
std::string recover_csv(const RecoverPart& part);

/// Reads a text of recover_csv(), with the estimates by `truths`. `file`: its name in errors.
/// Errors (input), by line: text that is not such a table.
Result<std::vector<RecoverRun>> recover_runs(std::string_view text, const std::string& file,
                                             const std::vector<RecoverTruth>& truths);

}  // namespace awmr
