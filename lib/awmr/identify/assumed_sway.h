/// Resistance to sliding sideways where neither the vehicle's file nor a log shows it: that of tyres as they
/// commonly are, with the whole of their range as its uncertainty. Private to identify/.
///
/// A tyre resists sliding with c times its load per radian of slip, and at the speed u the slip is v/u:
///
///     F_y = c m g v/u,    over F_max = m/m':    sway.alpha = c g m'/u
///
/// c is 15 for rubber on asphalt, 5 for hard plastic and less than 1 for wheels that slide already, as those of
/// a skid-steered vehicle in its turns: 0.5 to 16, taken as a 95 % interval in the logarithm. u is half of the
/// fastest speed in the trials, where scenarios are driven.
#pragma once

#include <optional>

#include "awmr/identify/main_values.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// The name of this origin in model.json (`method`).
inline constexpr const char* kAssumedSwayMethod = "assumed of common tyres";

/// Sets it, with its share of the covariance, and adds a finding (`assumed-sway`). Does nothing if
/// the model has a value, knows nothing of turning or no m', or no trial has a speed.
void assume_sway(const TrialData& data, MainValues& values);

}  // namespace awmr
