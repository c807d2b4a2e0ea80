/// Logs of vehicles that received several commands in the time between two rows. The commands of
/// such a log seem to change smoothly between the rows. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/choice/family_fit.h"

namespace awmr {

/// True if straight lines between the rows describe the commands better than steps. This is so if a
/// joystick or a controller changes the commands more often than the log has rows. Returns false
/// without a fit in two cases: the commands of a log change in less than half of its rows, or they
/// are already replaced by such lines or by held set-points (set_points.h).
///
/// In all other cases, fits the resistance families of `first` to interpolated(logs), with a free
/// delay of the commands, without wheel slip, and with a search for terms if `first` has slip or
/// late commands. Returns true if the AIC of this fit is lower than that of `first` by more than
/// kFamilyAicThreshold. If `first` has late commands (late time stamps) or wheel slip, the AIC of
/// the new fit may even be up to 10 higher, because both have nearly the same effect as straight
/// lines. `power_law`: options of `first`.
bool are_commands_smooth(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         const FamilyFit& first);

/// Returns the logs with additional rows in which the commands follow straight lines from row to
/// row. The additional rows have no measurements. Gaps of the log (kGapSteps) get no additional
/// rows.
std::vector<DrivingLog> interpolated(const std::vector<DrivingLog>& logs);

Finding interpolated_commands_finding(const std::string& file);

}  // namespace awmr
