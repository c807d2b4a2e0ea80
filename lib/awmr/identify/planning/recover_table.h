/// recovery.csv as text, in both directions. Private to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// Upper bound of an estimate: the sum of a million squares stays finite.
inline constexpr double kLargestEstimate = 1e150;

/// The text of recovery.csv, a row for each run: `run,refused`, and, for every parameter that at
/// least one run gave, `NAME,NAME.std_error,NAME.ci95_lo,NAME.ci95_hi`, empty where this run did
/// not.
std::string recover_csv(const RecoverPart& part);

/// The rows of a text that recover_csv() wrote, with their estimates by `truths`; `file` names it in
/// errors. Errors (input), by line: text that is not such a table.
Result<std::vector<RecoverRun>> recover_runs(std::string_view text, const std::string& file,
                                             const std::vector<RecoverTruth>& truths);

}  // namespace awmr
