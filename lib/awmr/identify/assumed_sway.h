/// Default sway resistance, for models without a value from the vehicle file or a log. The value is
/// that of common tyres, and its 95 % interval is the spread between tyres. Private to identify/.
///
/// A tyre's lateral force is its cornering stiffness c times its load m g times its slip angle. At
/// the forward speed u and the lateral speed v the slip angle is v/u. The sway resistance
/// sway.alpha is this force divided by v and by F_max = m/m', where m' is the mass m divided by
/// F_max:
///
///     F_y = c m g v/u,    sway.alpha = F_y/(v F_max) = c g m'/u
///
/// c in 1/rad is 15 for rubber on asphalt, 5 for hard plastic, and less than 1 for wheels that
/// already slide, as in the turns of a skid-steered vehicle. The value used is 2.8, the geometric
/// mean of the 95 % interval 0.5 to 16 (ln c normal). u is half of the highest speed in the trials.
#pragma once

#include <optional>

#include "awmr/identify/main_values.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// Value of `method` in model.json for the assumed sway resistance.
inline constexpr const char* kAssumedSwayMethod = "assumed of common tyres";

/// Sets the assumed sway resistance and its covariance, and adds the finding `assumed-sway`. Does
/// nothing in three cases: the model already has a sway resistance; it lacks the yaw resistance a3,
/// the yaw inertia I'z or the mass m'; or no trial has a speed above 0.
void assume_sway(const TrialData& data, MainValues& values);

}  // namespace awmr
