/// Detects copied rows in a table of runs. Copies narrow every interval as if they had been driven.
/// Private to this folder.
///
/// A row repeats an earlier one if all settings (forces, angle, distance, turns) and all readings
/// are the same to the last digit. Separate runs may agree by chance. Two readings of standard
/// deviation s, rounded to q, are the same with probability
///
///     p = erf(a) - (1 - exp(-a^2))/(a sqrt(pi)),   a = q/(2 s)
///
/// (the mean over all places of the rounding; 0.28 q/s for q << s, and nearly 1 for q >> s). Among
/// rows of equal settings, a row repeats one of the m different readings before it with probability
/// at most m p. The sum of these over the table is L, the expected number of repeats by chance. k
/// repeated rows are reported if
///
///     P(k or more) = sum over j >= k of L^j exp(-L)/j! <= 1/100
///
/// which is an upper bound for independent rows [Hoeffding 1956; Anderson and Samuels 1967, for
/// k >= L + 1]. s is the smallest plausible scatter: 0.3 % of the reading (1 % for stops, which
/// begin at different speeds), or the scatter of the table's own rows of equal settings, if less.
/// The error of a stop watch would add to it but is omitted: a time in tenths may be automatic.
#pragma once

#include <string_view>
#include <vector>

#include "trial_reader.h"

namespace awmr {

struct RepeatRule {
  /// Columns that are equal in a repeated run; those missing from the table are skipped.
  std::vector<std::string_view> settings;
  /// The reading, and the column that replaces it if the table does not have it.
  std::string_view timed = "elapsed_s";
  std::string_view printed = {};  ///< may be empty
  double scatter = 0.003;         ///< relative standard deviation of the reading
};

/// Adds the warning `repeated-rows` if chance does not explain how many of `rows` repeat an earlier
/// one.
void find_repeated_rows(const TrialReader& reader, const std::vector<std::size_t>& rows,
                        const RepeatRule& rule, std::vector<Finding>& findings);

}  // namespace awmr
