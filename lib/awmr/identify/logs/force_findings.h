/// Findings about forces that the model does not contain (extra_forces.h). Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// `stribeck-friction` for the surge or the yaw resistance, and `slope`, if these forces are larger
/// than two standard errors.
std::vector<Finding> force_findings(const LogFit& fit, const std::string& file);

}  // namespace awmr
