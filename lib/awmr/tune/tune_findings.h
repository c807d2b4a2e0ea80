/// Findings of a tuning: limits of the gains, and warnings.
#pragma once

#include <vector>

#include "awmr/model/record.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Findings of the tuned gains on fresh draws: a warning for each goal that they do not confirm
/// (`goal-missed`, `goal-open`) and for each mode in which fewer than 95 % of the runs settle after
/// every step (`unsettled`), per scenario if there are several. Arguments as in RobustTuning.
std::vector<Finding> evaluation_findings(const std::vector<EvaluatedGains>& evaluated,
                                         const std::vector<EvaluatedGains>& evaluated_by_scenario,
                                         const std::vector<EvaluatedGoal>& goals);

/// All findings of a tuning: those of the fresh draws (of nominal gains, or without draws: of the
/// tuned scenarios), then those that do not depend on them. A part (options.shard) has the latter
/// only; merge_tune_shards() adds the others. Precondition: tuned by tune() with `options`.
std::vector<Finding> tune_findings(const Model& model, const TuneOptions& options,
                                   const Tuning& tuning);

}  // namespace awmr
