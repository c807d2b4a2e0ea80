/// Limit of a disturbance observer's bandwidth.
#pragma once

#include <string>

#include "awmr/core/result.h"

namespace awmr {

/// Errors (input), at `place`: L T_s >= 1, with which the observer's estimate would oscillate.
Status check_observer_rate(double bandwidth_radps, double sample_time_s, const std::string& place);

}  // namespace awmr
