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

/// Searches for the slowest inputs: at and beyond the limits, tiny, subnormal, not finite, headings
/// of many turns, moving references. If the mission has points, they are replaced by points on the
/// vehicle or anywhere. The slowest input so far is mutated repeatedly. The sequence is
/// deterministic; each mode gets a third of `steps`, rounded up. Errors: those of the executors.
Result<Hostile> provoke(Executor& chip, Executor& host, const SafetyLimits& limits,
                        const Mission& mission, std::size_t steps, const Progress& progress = {});

}  // namespace awmr::pil
