// Differences between the chip's run and the host's runs, signal by signal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "awmr/simulate/simulate.h"
#include "loop.h"

namespace awmr::pil {

struct Difference {
  /// By name, in the signal's unit: largest absolute difference over the rows that both runs have;
  /// infinite if a value is finite in only one of the runs.
  std::vector<std::pair<std::string, double>> signals;
  bool same_length = true;  ///< both runs have the same number of rows

  double largest() const;  ///< largest difference of all signals in SI units, that is, without
                           ///< heading_deg
  double of(const std::string& signal) const;  ///< difference of one signal; infinite for an
                                               ///< unknown signal
};

/// Compares two runs of run_loop(): the vehicle's state, and the outputs of the control step as the
/// executors returned them, before the actuators.
Difference difference(const std::vector<LoopRow>& a, const std::vector<LoopRow>& b);
/// Compares a run of run_loop() with a run of simulate(), which computes in double. The commands
/// compared are those that the actuators received.
Difference difference(const std::vector<LoopRow>& a, const Run& b);

/// Largest distance of a heading in `a` from the range of the headings in `b` at the previous, the
/// same and the next sample, deg, >= 0; infinite if a heading is not finite. The neighbouring
/// samples are included because, by rounding, one run may start to turn one sample before the
/// other.
double heading_apart_deg(const std::vector<LoopRow>& a, const Run& b);

/// Clock cycles of a control step: least, mean and most of a run.
struct Cycles {
  unsigned min = 0;
  double mean = 0.0;
  unsigned max = 0;
};
/// Returns the least, mean and largest cycles of the rows. Rows without cycles (steps on the host)
/// are ignored.
Cycles cycles_of(const std::vector<LoopRow>& rows);

}  // namespace awmr::pil
