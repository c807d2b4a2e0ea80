// Searches for the inputs with which a control step takes the most clock cycles.
#pragma once

#include <cstddef>

#include "awmr/core/progress.h"
#include "executor.h"

namespace awmr::pil {

/// Results of control steps with inputs that no vehicle produces.
struct Hostile {
  unsigned cycles = 0;        ///< cycles of the longest step, including the setup of new points
  std::size_t steps = 0;      ///< number of steps tried
  std::size_t differing = 0;  ///< steps whose outputs differ from the host's in any bit
};

/// Options of the search.
struct HostileSearch {
  std::size_t steps = 0;   ///< number of steps; each mode gets a third, rounded up
  bool has_fixes = false;  ///< true: the firmware estimates its position from GPS fixes
};

/// Searches for the inputs with the slowest step, by repeatedly changing the slowest input so far.
/// Inputs are at and beyond the limits of `limits`, tiny, subnormal or not finite; heading angles
/// can be many turns. Points of the mission are replaced by random points, most of them near the
/// vehicle. A GPS fix is new (up to 2 s old, or with any time stamp) or repeated. The sequence is
/// deterministic. The host executes the same steps, and its outputs are compared with the chip's.
/// Errors: those of the executors.
Result<Hostile> provoke(Executor& chip, Executor& host, const SafetyLimits& limits,
                        const Mission& mission, const HostileSearch& search,
                        const Progress& progress = {});

}  // namespace awmr::pil
