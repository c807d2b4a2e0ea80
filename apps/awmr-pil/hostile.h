// The most cycles that a step can be made to take.
#pragma once

#include <cstddef>

#include "awmr/core/progress.h"
#include "executor.h"

namespace awmr::pil {

/// What was found with inputs that no vehicle gives.
struct Hostile {
  unsigned cycles = 0;        ///< the most of any step, with the following of new points in it
  std::size_t steps = 0;      ///< that were tried
  std::size_t differing = 0;  ///< whose outputs are not the host's, bit for bit
};

/// Looks for the inputs that take the chip longest: at and beyond the limits, tiny, subnormal, no
/// numbers, headings of many turns, references that move; where the mission has points, others that
/// lie on the vehicle or anywhere. What took longest so far is changed a little, again and again.
/// The same steps every time. Errors: the executors'.
Result<Hostile> provoke(Executor& chip, Executor& host, const SafetyLimits& limits,
                        const Mission& mission, const Progress& progress = {});

}  // namespace awmr::pil
