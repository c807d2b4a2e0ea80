/// Causes of runs that do not settle with the tuned gains, found by simulation: sensor noise, or an
/// error of the model. Private to tune/.
#pragma once

#include <optional>

#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Tells whether noise keeps the runs from settling: without noise, at least kSettledShare of them
/// settle, in the duration of the scenarios or in four times this duration, but not with noise.
/// (Gains that are slow because of limits on noise need more time.) Empty if not.
/// Precondition: fewer than kSettledShare of the runs settle.
std::optional<NoiseEffect> noise_effect(const ObjectiveSetting& setting,
                                        const Gains<double>& gains);

/// As noise_effect(), but of runs of the identified vehicle only, in place of the drawn vehicles:
/// noise and errors of the model together keep runs from settling. Empty if these runs settle with
/// noise.
std::optional<NoiseEffect> noise_effect_on_identified(const ObjectiveSetting& setting,
                                                      const Gains<double>& gains);

/// Returns the error of the model that most keeps runs from settling, by simulation: one quantity
/// of all drawn vehicles at a time gets its identified value. Empty if at least half of the
/// unsettled runs do not settle with the identified values of all quantities either.
std::optional<UnsettlingError> unsettling_error(const ObjectiveSetting& setting,
                                                const Gains<double>& gains);

}  // namespace awmr
