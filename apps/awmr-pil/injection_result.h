// Evaluates a run with an injected fault.
#pragma once

#include <cstddef>
#include <vector>

#include "loop.h"
#include "report.h"

namespace awmr::pil {

/// Returns the indices of the samples before which the chip was restarted, in increasing order.
std::vector<std::size_t> restarts_of(const std::vector<LoopRow>& rows);

/// Compares the faults and commands of a run with those that its injection must cause.
Injected injected_of(const LoopSetup& setup, const std::vector<LoopRow>& rows);

}  // namespace awmr::pil
