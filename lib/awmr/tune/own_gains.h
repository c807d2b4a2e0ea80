/// Separate gains for each mode of yaw control. Private to tune/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/core/result.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Searches gains for each mode alone. A mode keeps the gains of `common` if its search fails, if
/// its objective falls by less than 5 %, or if fewer of its runs settle. Returns one Tuning with
/// all modes: the gains of combined mode in Tuning::gains, those of the other modes in Tuning::own,
/// and a certificate for all modes. Empty if all modes keep the gains of `common`.
///
/// `setting`: the setting in which `common` was tuned for all modes. `search`: tunes for one mode
/// in that setting. `held_out`: a scenario that the searches do not use.
std::optional<Tuning> with_own_gains(const ObjectiveSetting& setting, const Scenario& held_out,
                                     const Tuning& common,
                                     const std::function<Result<Tuning>(YawMode)>& search);

}  // namespace awmr
