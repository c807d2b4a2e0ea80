/// Detects copied rows in a table of runs. Copies make confidence intervals too narrow. Private to
/// this folder.
///
/// A row repeats an earlier row if all settings (forces, angle, distance, turns) and the reading
/// (time or speed) are the same to the last digit. Separate runs may also agree by chance: two
/// readings with standard deviation s, rounded to multiples of q, are the same with probability
///
///     p = erf(a) - (1 - exp(-a^2))/(a sqrt(pi)),   a = q/(2 s)
///
/// (averaged over the position of the mean between two multiples of q; 0.28 q/s for q << s, nearly
/// 1 for q >> s). For a row, m is the number of rows above it with the same settings; of several
/// such rows with equal readings, only one counts. The row repeats one of these m readings by
/// chance with probability at most m p. The sum of m p over the table is L, the expected number of
/// repeats by chance. The check reports k repeated rows if
///
///     P(k or more) = sum over j >= k of L^j exp(-L)/j! <= 1/100
///
/// This Poisson probability is an upper bound for independent rows [Hoeffding 1956; Anderson and
/// Samuels 1967, for k >= L + 1]. s is the smallest plausible scatter of repeated runs: 0.3 % of
/// the reading (1 % for stop times). If the table's rows with equal settings scatter less, s is
/// their scatter. s does not include the error of a stop watch, because times in tenths of a second
/// may have been taken automatically.
#pragma once

#include <string_view>
#include <vector>

#include "trial_reader.h"

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
