/// Logs whose commands change smoothly between the rows. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/family_fit.h"
#include "awmr/identify/options.h"

namespace awmr {

/// True if straight lines between the rows describe the commands better than steps: a joystick or a
/// controller changes them more often than the log has rows. The families of `first` are fitted to
/// interpolated(log) as well, with a free delay of the commands, and the AIC of that fit is lower
/// by more than kFamilyAicThreshold. If `first` has late commands, which resemble lines, it may be
/// higher by 10. Logs are fitted only if a command changes in at least half of the rows.
/// `power_law`: options of `first`.
bool are_commands_smooth(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         const FamilyFit& first, const IdentifyOptions& options);

/// The logs with rows without measurements between their rows, where the commands lie on the
/// straight lines between those of the rows. A gap in the log (kGapSteps) is not interpolated.
std::vector<DrivingLog> interpolated(const std::vector<DrivingLog>& logs);

/// The warning `interpolated-commands`.
Finding interpolated_commands_finding(const std::string& file);

}  // namespace awmr
