/// Work of a search for gains: its limit, and the notice of a long search. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Error (input) if all evaluations together take more than 1e11 RK4 steps (some hours). Calls
/// TuneOptions::notice if the search takes more than about 10 s.
Status check_search_work(const TuneOptions& options, const std::vector<Scenario>& scenarios,
                         const Plant<double>& plant, const Model& model);

}  // namespace awmr
