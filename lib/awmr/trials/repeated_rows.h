/// Rows of a table of runs that repeat an earlier one: copies, which narrow every interval as if they had
/// been driven. Private to this folder.
///
/// A row repeats an earlier one where all settings (forces, angle, distance, turns) and all readings are
/// the same to the last digit. Runs that were driven twice may agree by chance. Two readings of standard
/// deviation s, rounded to q, are the same with probability
///
///     p = erf(a) - (1 - exp(-a^2))/(a sqrt(pi)),   a = q/(2 s)
///
/// (the mean over all places of the rounding; 0.28 q/s for q << s, and nearly 1 for q >> s). A row among
/// others with its settings repeats one of the m different readings before it with at most m p; the sum of
/// these over the table is L, how many repeat by chance. k rows that repeat are told where
///
///     P(k or more) = sum over j >= k of L^j exp(-L)/j! <= 1/100
///
/// which is no less than that of independent rows [Hoeffding 1956; Anderson and Samuels 1967, for k >= L + 1].
/// s is what runs differ by at the least: 0.3 % of the reading (no course is driven more alike; of stops, which
/// begin at speeds of their own, 1 %), or what the table's own rows of like settings show, where that is less. A
/// stop watch adds to it, and is left out: a time in tenths may be an automatic one.
#pragma once

#include <string_view>
#include <vector>

#include "trial_reader.h"

namespace awmr {

struct RepeatRule {
  /// The same in a run that was driven again; those that the table has not are passed over.
  std::vector<std::string_view> settings;
  /// The reading that was taken, and the one that stands for it in a table without it.
  std::string_view timed = "elapsed_s";
  std::string_view printed = {};  ///< may be none
  double scatter = 0.003;         ///< standard deviation over the reading
};

/// Adds `repeated-rows`, a warning, where chance does not explain how many of `rows` repeat one before.
void find_repeated_rows(const TrialReader& reader, const std::vector<std::size_t>& rows,
                        const RepeatRule& rule, std::vector<Finding>& findings);

}  // namespace awmr
