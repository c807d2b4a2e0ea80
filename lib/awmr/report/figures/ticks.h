/// Tick positions and labels of a numeric axis. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"

namespace awmr {

struct Tick {
  double value = 0.0;
  std::string text = {};  ///< with a real minus sign; divided by 10^exponent of Ticks
};

struct Ticks {
  std::vector<Tick> list = {};
  int exponent = 0;  ///< a multiple of 3; the axis title must show it if it is not 0
};

/// Ticks at multiples of 1, 2 or 5 times a power of ten within `range`: at most `most` (>= 2), at
/// least one, all with the same number of decimals.
/// Precondition: range.hi - range.lo is positive, finite and over 1e-7 of the larger end.
Ticks ticks_in(Interval range, int most);

}  // namespace awmr
