/// Display order of findings, which are messages about data and results: those with the largest
/// effect on the numbers come first.
#pragma once

#include <string_view>
#include <vector>

#include "awmr/model/record.h"

namespace awmr {

/// Effects of findings on the numbers, the largest first.
enum class Effect {
  kRefusal,        ///< a request could not be fulfilled
  kWithdrawn,      ///< a value or an interval is invalid or withheld
  kContradiction,  ///< a file contradicts itself or another in units, signs or left and right
  kDoubt,          ///< any other warning
  kAssumption,     ///< a value that is not supported by data
  kNote,           ///< any other note
};

/// The effect of a finding. Error: kRefusal. Warning: the effect of its code in the table of
/// finding_rank.cpp, else kDoubt. Note: kAssumption if the table gives this effect to its code,
/// else kNote.
Effect effect_of(const Finding& finding);

/// Returns the findings in display order: the errors, then the first finding of each other code,
/// then the further findings of these codes, then the notes. Within each of these groups, findings
/// are sorted by the effect of their code; findings with the same effect keep their order.
/// `findings` must outlive the result.
std::vector<const Finding*> by_effect(const std::vector<Finding>& findings);

}  // namespace awmr
