// Searches for the inputs with which a control step takes the most clock cycles.
#pragma once

#include <cstddef>

#include "awmr/core/progress.h"
#include "executor.h"

namespace awmr::pil {

/// Results of the search: longest step, number of steps, and steps in which chip and host differ.
struct Hostile {
  unsigned cycles = 0;        ///< cycles of the longest step, including the setup of new points
  std::size_t steps = 0;      ///< number of steps tried
  std::size_t differing = 0;  ///< steps in which chip and host differ in any output bit
};

/// Options of the search.
struct HostileSearch {
  /// Number of steps. Each of the three yaw-control modes gets a third, rounded up.
  std::size_t steps = 0;
  bool has_fixes = false;  ///< true: the firmware estimates its position from GPS fixes
};

/// Searches for the input with the slowest control step, by repeatedly changing the slowest input
/// so far. Inputs are values at and beyond `limits`, tiny, subnormal or not finite. Headings can be
/// many turns. The points of the mission are replaced by random points, most of them near the
/// vehicle. A GPS fix is new (up to 2 s old, or with a random time) or repeated. The sequence is
/// deterministic. The host executes the same steps, and its outputs are compared with the chip's.
/// Errors: those of the executors.
Result<Hostile> provoke(Executor& chip, Executor& host, const SafetyLimits& limits,
                        const Mission& mission, const HostileSearch& search,
                        const Progress& progress = {});

}  // namespace awmr::pil
