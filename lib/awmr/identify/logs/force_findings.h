/// Findings about forces that the model does not contain (extra_forces.h). Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// One finding for each force of extra_forces.h that is larger than two standard errors.
std::vector<Finding> force_findings(const LogFit& fit, const std::string& file);

/// Withdraws the intervals of a resistance with a Stribeck friction above 5 % of its Coulomb
/// friction. The logs do not show the true form of the decrease with speed, on which all terms of
/// this resistance depend. (m' and I'z depend on it much less.)
void withdraw_by_stribeck(LogFit& fit);

}  // namespace awmr
