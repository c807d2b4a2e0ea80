/// Display order of findings: those with the largest effect on the numbers first.
#pragma once

#include <string_view>
#include <vector>

#include "awmr/model/record.h"

namespace awmr {

/// Effects of findings on the numbers, the largest first.
enum class Effect {
  kRefusal,        ///< a request could not be fulfilled
  kWithdrawn,      ///< a value or an interval is invalid or withheld
  kContradiction,  ///< units, signs or sides of a file are contradictory; for one row: kDoubt
  kDoubt,          ///< any other warning
  kAssumption,     ///< a value that is not supported by data
  kNote,           ///< does not change any number
};

/// An error is a refusal. A warning has the effect of its code, else kDoubt; a note is kNote unless
/// its code is an assumption.
Effect effect_of(const Finding& finding);

/// Sorted by effect; within one effect the first finding of each code, then the others, each in the
/// order of the list. The list must outlive the result.
std::vector<const Finding*> by_effect(const std::vector<Finding>& findings);

}  // namespace awmr
