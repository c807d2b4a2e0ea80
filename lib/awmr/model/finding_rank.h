/// The order in which findings are shown: what changes the numbers most comes first.
#pragma once

#include <string_view>
#include <vector>

#include "awmr/model/record.h"

namespace awmr {

/// Effects of findings on the numbers, the largest first.
enum class Effect {
  kRefusal,        ///< something that was asked for could not be done
  kWithdrawn,      ///< a value or an interval does not hold, or is withheld
  kContradiction,  ///< units, signs or sides of a file contradict each other; of one row: kDoubt
  kDoubt,          ///< any other warning
  kAssumption,     ///< a value that no data show
  kNote,           ///< changes no number
};

/// An error is a refusal. A warning has the effect of its code, else kDoubt; a note is kNote unless its
/// code is an assumption.
Effect effect_of(const Finding& finding);

/// Effect by effect; within one effect the first finding of each code, then the others, each as they
/// stand in the list. The list outlives the result.
std::vector<const Finding*> by_effect(const std::vector<Finding>& findings);

}  // namespace awmr
