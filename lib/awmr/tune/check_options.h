/// Checks of the options of a search. Private to tune/.
#pragma once

#include "awmr/core/result.h"
#include "awmr/model/vehicle.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Checks the options of a search. Errors (input): all options that are out of range or contradict
/// another option.
Status check_options(const TuneOptions& options, const Vehicle& vehicle);

}  // namespace awmr
