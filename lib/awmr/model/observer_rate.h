/// How fast a disturbance observer may be.
#pragma once

#include <string>

#include "awmr/core/result.h"

namespace awmr {

/// Errors (input), at `place`: L T_s >= 1, where the estimate of a sampled observer would swing.
Status check_observer_rate(double bandwidth_radps, double sample_time_s, const std::string& place);

}  // namespace awmr
