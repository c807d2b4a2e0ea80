/// Logs whose commands were interpolated between set-points by the program that wrote the log.
/// Private to identify/.
///
/// A controller holds each set-point until the next one. If a log has more rows than set-points,
/// its program may interpolate linearly: the log then shows straight lines between the set-points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/choice/family_fit.h"

namespace awmr {

/// Returns the logs with every interpolated command replaced by the last set-point before it. If
/// one of the two forces is interpolated, both are replaced.
///
/// A command counts as interpolated if it changes in at least 40 rows, and if most of these rows
/// lie on straight lines whose lengths are multiples of the same number of rows. This number is at
/// least 2 and lasts at most 0.5 s.
///
/// Empty if no command is interpolated, or if the commands of a log were already replaced by held
/// set-points or by straight lines (DrivingLog::has_held_set_points, has_interpolated_commands).
std::optional<std::vector<DrivingLog>> with_held_set_points(const std::vector<DrivingLog>& logs);

/// True if `held`, the logs with held set-points, describe the motion about as well as the original
/// logs. Fits the families of `first` to `held`, starting without command delays and motor lag. The
/// AIC of this fit may be up to 10 above that of `first`. It need not be lower, because real
/// commands hardly ever form straight lines of equal length. `power_law`: options of `first`.
bool are_set_points_held(const std::vector<DrivingLog>& held, const LogFitOptions& power_law,
                         const FamilyFit& first);

Finding interpolated_set_points_finding(const std::string& file);

}  // namespace awmr
