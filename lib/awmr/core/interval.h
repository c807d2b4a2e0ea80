/// A closed interval [lo, hi].
#pragma once

namespace awmr {

struct Interval {
  double lo = 0.0;
  double hi = 0.0;
  bool contains(double value) const { return lo <= value && value <= hi; }
};

}  // namespace awmr
