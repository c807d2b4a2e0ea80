/// Findings about forces that the model does not contain (extra_forces.h). Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Returns one finding for each force of extra_forces.h that differs from 0 by more than two
/// standard errors.
std::vector<Finding> force_findings(const LogFit& fit, const std::string& file);

/// Withdraws the intervals of a resistance whose Stribeck friction is above 5 % of its Coulomb
/// friction. All terms of this resistance depend on how the friction decreases with speed, and the
/// logs do not show the true form of this decrease. (m' and I'z depend on it much less.)
void withdraw_by_stribeck(LogFit& fit);

}  // namespace awmr
