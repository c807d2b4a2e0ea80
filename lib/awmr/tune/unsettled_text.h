/// Messages about runs that do not settle, for findings and errors. Private to tune/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/tune/tune.h"

namespace awmr {

/// Returns a message for each advice, with all scenarios and modes that get this advice, and the
/// shares of their runs that settle: "of the runs with the tuned gains, 40 % (SCENARIO, MODE), 0 %
/// (...) settle after every heading step. ADVICE".
std::vector<std::string> unsettled_texts(std::span<const UnsettledRuns> unsettled);

}  // namespace awmr
