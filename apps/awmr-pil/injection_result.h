// Evaluates a run with an injected fault.
#pragma once

#include <cstddef>
#include <vector>

#include "loop.h"
#include "report.h"

namespace awmr::pil {

/// Returns the numbers of the steps before which the chip was restarted, in increasing order.
std::vector<std::size_t> restarts_of(const std::vector<LoopRow>& rows);

/// Checks whether a run shows the faults and the safe commands that its injection must cause.
Injected injected_of(const LoopSetup& setup, const std::vector<LoopRow>& rows);

}  // namespace awmr::pil
