/// Where an axis of numbers has its ticks, and what stands at them. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"

namespace awmr {

struct Tick {
  double value = 0.0;
  std::string text = {};  ///< with a real minus sign, over 10^exponent of Ticks
};

struct Ticks {
  std::vector<Tick> list = {};
  int exponent = 0;  ///< a multiple of 3; the axis has to say it where it is not 0
};

/// At multiples of 1, 2 or 5 times a power of ten within `range`, at most `most` of them (>= 2) and
/// at least one, all with the same number of decimals.
/// Precondition: range.hi - range.lo is positive, finite and over 1e-7 of the larger end.
Ticks ticks_in(Interval range, int most);

}  // namespace awmr
