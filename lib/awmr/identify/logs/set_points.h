/// Logs whose commands were interpolated between set-points by the program that wrote the log.
/// Private to identify/.
///
/// A controller holds each set-point until the next one. A log with more rows than set-points that
/// is filled by linear interpolation shows straight lines between them instead.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/family_fit.h"
#include "awmr/identify/options.h"

namespace awmr {

/// The logs with every command held at its last set-point. Empty if no command looks interpolated:
/// less than half of its changes lie on straight lines of a multiple of the same number of rows, or
/// these are more than 0.5 s.
std::optional<std::vector<DrivingLog>> with_held_set_points(const std::vector<DrivingLog>& logs);

/// True if `held`, the logs with held set-points, describe the motion as well as the logs
/// themselves: the AIC of the families of `first`, fitted to them without delays or motor lag at
/// first, is at most 10 higher. Straight lines of equal length are hardly ever real commands, so
/// they need not be better. `power_law`: options of `first`.
bool are_set_points_held(const std::vector<DrivingLog>& held, const LogFitOptions& power_law,
                         const FamilyFit& first, const IdentifyOptions& options);

/// The warning `interpolated-set-points`.
Finding interpolated_set_points_finding(const std::string& file);

}  // namespace awmr
