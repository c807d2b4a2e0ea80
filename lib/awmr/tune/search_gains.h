/// Search of the gains on given vehicles and scenarios. Private to tune/.
#pragma once

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Searches the gains on one setting, then evaluates them in the scenario `held_out`, which the
/// search does not use. If runs need an observer to settle (TuneOptions::adds_observer), searches
/// again with an observer. Errors: those of tune().
Result<Tuning> search_gains(const Model& model, const ObjectiveSetting& setting,
                            const ConstraintContext& context, const TuneOptions& requested,
                            const Scenario& held_out);

}  // namespace awmr
