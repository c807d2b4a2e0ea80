/// recovery.csv as text, in both directions. Private to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// No estimate of a run is larger: the squares of a million of them have a finite sum.
inline constexpr double kLargestEstimate = 1e150;

/// The text of recovery.csv, a row for each run: `run,refused`, and of every parameter that some run
/// gave `NAME,NAME.std_error,NAME.ci95_lo,NAME.ci95_hi`, empty where this run did not.
std::string recover_csv(const RecoverPart& part);

/// The rows of a text that recover_csv() wrote, with their estimates by `truths`; `file` names it in
/// errors. Errors (input), by line: it is none.
Result<std::vector<RecoverRun>> recover_runs(std::string_view text, const std::string& file,
                                             const std::vector<RecoverTruth>& truths);

}  // namespace awmr
