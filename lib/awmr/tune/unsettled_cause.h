/// Causes of runs that do not settle with the tuned gains, found by simulation: sensor noise, or an
/// error of the model. Private to tune/.
#pragma once

#include <optional>

#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns the effect of Coulomb friction in yaw if it keeps runs of this mode from settling: at
/// least kSettledShare of them settle if neither the vehicles nor the control law have this
/// friction. Precondition: fewer than kSettledShare of the runs settle.
std::optional<FrictionEffect> friction_effect(ObjectiveSetting setting, const Gains<double>& gains,
                                              YawMode mode);

/// Returns the effect of sensor noise if it keeps the runs from settling: at least kSettledShare of
/// them settle without noise, but not with noise. Both are tried with the duration of the
/// scenarios, then with four times this duration, because gains that limits on noise make slow need
/// more time. Empty if noise is not the cause. Precondition: fewer than kSettledShare of the runs
/// settle.
std::optional<NoiseEffect> noise_effect(const ObjectiveSetting& setting,
                                        const Gains<double>& gains);

/// As noise_effect(), but simulates the identified vehicle in place of the drawn vehicles. A result
/// means that noise and errors of the model together keep runs from settling. Empty if these runs
/// settle with noise.
std::optional<NoiseEffect> noise_effect_on_identified(const ObjectiveSetting& setting,
                                                      const Gains<double>& gains);

/// Returns the error of the model that keeps the most runs from settling, found by simulation: in
/// all drawn vehicles, one quantity at a time gets its identified value. Empty if at least half of
/// the unsettled runs do not settle with the identified values of all quantities either.
std::optional<UnsettlingError> unsettling_error(const ObjectiveSetting& setting,
                                                const Gains<double>& gains);

}  // namespace awmr
