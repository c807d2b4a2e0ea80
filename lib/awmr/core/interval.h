/// A closed interval [lo, hi].
#pragma once

namespace awmr {

struct Interval {
  double lo = 0.0;  ///< the lower end
  double hi = 0.0;  ///< the upper end, >= lo

  /// Includes both ends; false for NaN.
  bool contains(double value) const { return lo <= value && value <= hi; }
};

}  // namespace awmr
