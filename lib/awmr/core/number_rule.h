/// Permitted range of a number that comes from a file, the command line or a caller.
#pragma once

#include <limits>
#include <string>

#include "awmr/core/interval.h"

namespace awmr {

struct NumberRule {
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
  bool min_excluded = false;  ///< true: strictly above `min`
  bool max_excluded = false;  ///< true: strictly below `max`
};
inline constexpr NumberRule kAnyNumber{};
inline constexpr NumberRule kPositive{.min = 0.0, .min_excluded = true};
inline constexpr NumberRule kNonNegative{.min = 0.0};

/// True if the value is in the permitted range; false for NaN.
bool allows(const NumberRule& rule, double value);
/// True if lo <= hi and both ends are in the permitted range.
bool allows(const NumberRule& rule, const Interval& interval);
/// The permitted range as text: "a number above 0 and at most 1".
std::string describe(const NumberRule& rule);

}  // namespace awmr
