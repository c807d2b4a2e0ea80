/// Gains of their own for the modes of yaw control. Private to tune/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/core/result.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Searches gains for each mode alone. Returns them as one Tuning, with those of combined mode in
/// Tuning::gains and those of the other modes in Tuning::own. Tuning::certificate has all modes.
/// Empty
///   - if the search of a mode fails, or uses an observer, which the firmware has for all modes;
///   - if a mode settles less often than with the gains in `common`: in a share of the runs that is
///     lower by more than 0.05;
///   - if the objective, as the geometric mean over the modes, is not lower by at least 5 %.
/// `setting`: the setting in which `common` was tuned for all modes. `search`: tunes for one mode
/// in that setting.
std::optional<Tuning> with_own_gains(const ObjectiveSetting& setting, const Tuning& common,
                                     const std::function<Result<Tuning>(YawMode)>& search);

}  // namespace awmr
