/// Causes of runs that do not settle with the tuned gains, found by simulation: sensor noise, or an
/// error of the model. Private to tune/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

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

/// Returns the part of the unmodelled variation `open` that keeps the runs from settling: at least
/// kSettledShare of them settle without it. Tries the wheel forces, the mass factors, then both.
/// Empty if there is none.
std::optional<VariationEffect> variation_effect(const ObjectiveSetting& setting,
                                                const Gains<double>& gains,
                                                const UnmodelledVariation& open);

/// Returns each scenario and mode in which fewer than kSettledShare of the runs settle with the
/// tuned gains, with the causes and with changes that let the runs settle. `requested`: options as
/// the user gave them. If they have unmodelled variation, errors of the identified parameters are
/// not tried as a cause.
std::vector<UnsettledRuns> unsettled_runs(const Tuning& tuning, const ObjectiveSetting& setting,
                                          const ConstraintContext& context,
                                          const TuneOptions& requested);

}  // namespace awmr
