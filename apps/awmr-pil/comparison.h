// Differences between the chip's run and the host's runs, signal by signal.
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

/// Compares two runs of run_loop(): the outputs of the control step as the executors returned them,
/// and the vehicle's state.
Difference difference(const std::vector<LoopRow>& a, const std::vector<LoopRow>& b);
/// Compares a run of run_loop() with a run of simulate(), which computes in double.
Difference difference(const std::vector<LoopRow>& a, const Run& b);

/// Largest distance of a heading in `a` from the range of the headings in `b` at the previous, the
/// same and the next sample, deg, >= 0. Because of rounding, one of the runs may turn to its next
/// leg one sample earlier. Infinite if a heading is not finite.
double heading_apart_deg(const std::vector<LoopRow>& a, const Run& b);

/// Cycles per control step.
struct Cycles {
  unsigned min = 0;
  double mean = 0.0;
  unsigned max = 0;
};
Cycles cycles_of(const std::vector<LoopRow>& rows);

}  // namespace awmr::pil
