// Difference between two runs, signal by signal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "awmr/simulate/simulate.h"
#include "loop.h"

namespace awmr::pil {

struct Difference {
  /// Largest absolute difference of each signal over all rows; infinite if only one of the two is
  /// finite.
  std::vector<std::pair<std::string, double>> signals;
  bool same_length = true;  ///< both runs have the same number of rows

  double largest() const;
  double of(const std::string& signal) const;
};

/// Compares the outputs of the control step, as the executor returned them, and the vehicle's
/// state.
Difference difference(const std::vector<LoopRow>& a, const std::vector<LoopRow>& b);
/// Compares with a run of simulate(), which is in double.
Difference difference(const std::vector<LoopRow>& a, const Run& b);

/// Largest heading difference from the closest of the other run's headings at the same sample and
/// the samples before and after, deg. A leg may end one sample apart in the two runs because of
/// rounding. Infinite if only one is finite.
double heading_apart_deg(const std::vector<LoopRow>& a, const Run& b);

struct Cycles {
  unsigned min = 0;
  double mean = 0.0;
  unsigned max = 0;
};
Cycles cycles_of(const std::vector<LoopRow>& rows);

}  // namespace awmr::pil
