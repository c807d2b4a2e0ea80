// Differences between the chip's run and the host's runs, signal by signal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "awmr/simulate/simulate.h"
#include "loop.h"

namespace awmr::pil {

struct Difference {
  /// Names of the signals, each with the largest absolute difference between the two runs, in the
  /// signal's unit. Only rows that both runs have are compared. The difference is infinite if a
  /// value is finite in only one of the runs.
  std::vector<std::pair<std::string, double>> signals;
  bool same_length = true;  ///< both runs have the same number of rows

  /// Returns the largest difference of all signals except heading_deg, which is not in SI units.
  double largest() const;
  double of(const std::string& signal) const;  ///< difference of one signal; infinite for an
                                               ///< unknown signal
};

/// Compares two runs of run_loop(): vehicle states, and control outputs before the actuators round
/// them.
Difference difference(const std::vector<LoopRow>& a, const std::vector<LoopRow>& b);
/// Compares a run of run_loop() with a run of simulate(), which computes in double. Forces and
/// steering angles are compared after the rounding by the actuators.
Difference difference(const std::vector<LoopRow>& a, const Run& b);

/// Returns the largest heading difference between the runs, deg, >= 0; infinite if a heading is not
/// finite. At each sample, the heading of `a` is compared with the range of the headings of `b` at
/// the previous, the same and the next sample, because rounding alone can make one run turn one
/// sample before the other.
double heading_apart_deg(const std::vector<LoopRow>& a, const Run& b);

/// Clock cycles per control step of a run: smallest, mean and largest number.
struct Cycles {
  unsigned min = 0;
  double mean = 0.0;
  unsigned max = 0;
};
/// Ignores rows without cycles (steps on the host).
Cycles cycles_of(const std::vector<LoopRow>& rows);

}  // namespace awmr::pil
