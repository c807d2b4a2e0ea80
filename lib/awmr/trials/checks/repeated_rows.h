/// Detects copied rows in a table of runs, by the rule of CHECKS.md, "Repeated rows". Private to
/// trials/.
#pragma once

#include <string_view>
#include <vector>

#include "awmr/trials/trial_reader.h"

namespace awmr {

/// Columns of a table that are compared.
struct RepeatRule {
  /// Columns with the settings of a run; those missing from the table are skipped.
  std::vector<std::string_view> settings;
  std::string_view timed = "elapsed_s";  ///< column with the reading that is compared
  /// Column that is compared if any row lacks a value in the column `timed`; may be empty.
  std::string_view printed = {};
  double scatter = 0.003;  ///< relative standard deviation of the reading
};

/// Adds the warning `repeated-rows` if more of the `rows` repeat an earlier row than chance
/// explains.
void find_repeated_rows(const TrialReader& reader, const std::vector<std::size_t>& rows,
                        const RepeatRule& rule, std::vector<Finding>& findings);

}  // namespace awmr
