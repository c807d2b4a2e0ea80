/// Default sway resistance if neither the vehicle file nor a log gives it: that of common tyres,
/// with their whole range as its uncertainty. Private to identify/.
///
/// A tyre resists sliding with c times its load per radian of slip, and at the speed u the slip is
/// v/u:
///
///     F_y = c m g v/u,    over F_max = m/m':    sway.alpha = c g m'/u
///
/// c is 15 for rubber on asphalt, 5 for hard plastic and less than 1 for wheels that already slide,
/// as in the turns of a skid-steered vehicle. The range 0.5 to 16 is used as a 95 % interval of ln
/// c. u is half of the highest speed in the trials, a typical speed of scenarios.
#pragma once

#include <optional>

#include "awmr/identify/main_values.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// The name of this origin in model.json (`method`).
inline constexpr const char* kAssumedSwayMethod = "assumed of common tyres";

/// Sets the sway resistance and its covariance, and adds a finding (`assumed-sway`). Does nothing
/// if the model has a value already, has no turning parameters or no m', or if no trial has a
/// speed.
void assume_sway(const TrialData& data, MainValues& values);

}  // namespace awmr
