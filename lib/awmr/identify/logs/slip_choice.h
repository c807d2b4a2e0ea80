/// Comparison of wheel slip with the effects that resemble it, such as commands whose time stamps
/// are late. Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/family_fit.h"

namespace awmr {

/// Tries other explanations if the fit `chosen` has significant wheel slip or late commands: one of
/// the two in place of the other, and the other form of slip (WheelSlip::is_ratio). With each of
/// them, a reading rises earlier than the logged commands explain, so a fit can confuse them.
///
/// The fit with the lowest AIC becomes `chosen`. If the AIC of another fit is higher by less than
/// 10, the logs do not decide: the intervals of the parameters that differ between the fits by more
/// than one standard error are then withdrawn. Returns the finding `wheel-slip` that names both
/// explanations. Empty if nothing was withdrawn, or if `chosen` has no significant slip and no late
/// commands.
std::optional<Finding> decide_slip(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

}  // namespace awmr
