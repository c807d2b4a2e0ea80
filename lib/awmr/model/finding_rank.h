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
  kContradiction,  ///< a file contradicts itself or another in units, signs or left and right
  kDoubt,          ///< any other warning
  kAssumption,     ///< a value that is not supported by data
  kNote,           ///< any other note
};

/// The effect of a finding, by its severity and code. An error is kRefusal. A warning has the
/// effect of its code, or kDoubt if the code has none. A note is kNote, or kAssumption if its code
/// has this effect.
Effect effect_of(const Finding& finding);

/// Returns the findings in this order: errors; the first finding of each other code, by effect;
/// further findings of these codes, by effect; notes. Otherwise the order of the list is kept. The
/// list must outlive the result.
std::vector<const Finding*> by_effect(const std::vector<Finding>& findings);

}  // namespace awmr
