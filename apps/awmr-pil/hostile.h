// Search for the inputs that make a control step take the most cycles.
#pragma once

#include <cstddef>

#include "awmr/core/progress.h"
#include "executor.h"

namespace awmr::pil {

/// Results with inputs that no vehicle produces.
struct Hostile {
  unsigned cycles = 0;        ///< maximum over all steps, including the setup of new points
  std::size_t steps = 0;      ///< number of steps tried
  std::size_t differing = 0;  ///< steps whose outputs differ from the host's in any bit
};

struct HostileSearch {
  std::size_t steps = 6000;  ///< each mode gets a third, rounded up
  bool has_fixes = false;    ///< true: the firmware estimates its position from fixes
};

/// Searches for the slowest inputs: at and beyond the limits, tiny, subnormal, not finite, headings
/// of many turns, moving references. If the mission has points, they are replaced by points on the
/// vehicle or anywhere. Fixes are new, repeated, up to 2 s old or of any time. The slowest input so
/// far is mutated repeatedly. The sequence is deterministic. Errors: those of the executors.
Result<Hostile> provoke(Executor& chip, Executor& host, const SafetyLimits& limits,
                        const Mission& mission, const HostileSearch& search,
                        const Progress& progress = {});

}  // namespace awmr::pil
