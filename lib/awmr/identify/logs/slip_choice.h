/// Comparison of wheel slip with the effects that resemble it, such as commands whose time stamps
/// are late. Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/family_fit.h"

namespace awmr {

/// If the fit `chosen` has significant wheel slip or late commands, tries the alternatives: slip in
/// place of late commands or the reverse, and the second form of slip (slip ratio or slip speed,
/// WheelSlip::is_ratio). A fit can mistake slip for late commands, because both make a reading rise
/// earlier than the logged commands explain.
///
/// The fit with the lowest AIC becomes `chosen`. The logs do not decide if the AIC of another fit
/// is higher by less than 10, or if the difference is larger only because of a few rows
/// (aic_lead_of_most_rows()). These few rows are those in which a command changes: whether a
/// reading in such a row already shows the new command depends on the program that writes the log.
/// The intervals of the parameters that differ between the fits by more than one standard error are
/// then withdrawn, and the finding `wheel-slip` names both explanations. Empty if nothing was
/// withdrawn.
std::optional<Finding> decide_slip(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

}  // namespace awmr
