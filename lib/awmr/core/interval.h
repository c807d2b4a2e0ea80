/// A closed interval [lo, hi].
#pragma once

namespace awmr {

struct Interval {
  double lo = 0.0;  ///< lower end
  double hi = 0.0;  ///< upper end, >= lo

  /// True for values from lo to hi, both included; false for NaN.
  bool contains(double value) const { return lo <= value && value <= hi; }
};

}  // namespace awmr
