/// Comparison of wheel slip with the effects that resemble it, such as commands whose time stamps
/// are late. Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/family_fit.h"

namespace awmr {

/// If the fit `chosen` has significant wheel slip or late commands, tries the alternatives: one of
/// the two in place of the other, and the other form of slip (WheelSlip::is_ratio). A fit can
/// confuse them, because each of them makes a reading rise earlier than the logged commands
/// explain.
///
/// The fit with the lowest AIC becomes `chosen`. If the AIC of another fit is higher by less than
/// 10, or if only a few rows make the difference larger (aic_lead_of_most_rows()), the logs do not
/// decide. Such rows are those in which a command changes: whether a reading already shows the new
/// command depends on the program that writes the log. The intervals of the parameters that differ
/// between the fits by more than one standard error are then withdrawn, and the finding
/// `wheel-slip` names both explanations. Empty if nothing was withdrawn.
std::optional<Finding> decide_slip(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

}  // namespace awmr
