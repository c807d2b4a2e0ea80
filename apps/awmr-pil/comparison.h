// How far two runs are apart, signal by signal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "awmr/simulate/simulate.h"
#include "loop.h"

namespace awmr::pil {

struct Difference {
  /// The largest absolute difference of each signal over all rows; infinite where only one of the
  /// two is finite.
  std::vector<std::pair<std::string, double>> signals;
  bool same_length = true;  ///< as many rows in both

  double largest() const;
  double of(const std::string& signal) const;
};

/// Outputs of the control step as the executor gave them, and the vehicle's state.
Difference difference(const std::vector<LoopRow>& a, const std::vector<LoopRow>& b);
/// From a run of simulate(), which is in double.
Difference difference(const std::vector<LoopRow>& a, const Run& b);

/// The largest distance of the heading from those that the other run has at the same sample and at the
/// ones before and after it, deg: a leg may end at a sample of one run and at the next one of the other,
/// and rounding decides at which. Infinite where only one is finite.
double heading_apart_deg(const std::vector<LoopRow>& a, const Run& b);

struct Cycles {
  unsigned min = 0;
  double mean = 0.0;
  unsigned max = 0;
};
Cycles cycles_of(const std::vector<LoopRow>& rows);

}  // namespace awmr::pil
