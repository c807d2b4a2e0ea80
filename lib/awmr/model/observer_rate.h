/// Upper limit of the bandwidth of a disturbance observer, for the controller's sample time.
#pragma once

#include <string>

#include "awmr/core/result.h"

namespace awmr {

/// Checks that L T_s < 1, with the bandwidth L = `bandwidth_radps` and the sample time T_s =
/// `sample_time_s`. If the bandwidth were larger, the observer's estimate would oscillate. Errors
/// (input), at `place`: L T_s >= 1.
Status check_observer_rate(double bandwidth_radps, double sample_time_s, const std::string& place);

}  // namespace awmr
