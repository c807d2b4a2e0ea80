/// Logs whose commands change smoothly between the rows. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/family_fit.h"
#include "awmr/identify/options.h"

namespace awmr {

/// True if straight lines between the rows describe the commands better than steps. This is the
/// case if a joystick or a controller changes the commands more often than the log has rows.
/// Returns false without a fit if the commands of any log change in less than half of its rows, or
/// are already interpolated or held set-points.
///
/// Otherwise fits the families of `first` to interpolated(logs), with a free delay of the commands.
/// Returns true if the AIC of this fit is lower than that of `first` by more than
/// kFamilyAicThreshold. If `first` has late commands, whose effect resembles that of lines, the AIC
/// may instead be up to 10 higher. `power_law`: options of `first`.
bool are_commands_smooth(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         const FamilyFit& first);

/// Returns the logs with additional rows between their rows. The additional rows have no
/// measurements, and the commands follow straight lines between the logged ones. A gap in the log
/// (kGapSteps) is not interpolated.
std::vector<DrivingLog> interpolated(const std::vector<DrivingLog>& logs);

/// The warning `interpolated-commands`.
Finding interpolated_commands_finding(const std::string& file);

}  // namespace awmr
