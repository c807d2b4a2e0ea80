/// Findings (notes and warnings) of a tuning, for the output of `awmr tune`.
#pragma once

#include <span>
#include <vector>

#include "awmr/model/record.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Findings of the tuned gains on fresh draws, which are drawn vehicles that the search did not
/// use: a warning for each goal that these draws do not confirm (`goal-missed`, `goal-open`), and
/// one for each mode in which fewer than 95 % of the runs settle after every step (`unsettled`),
/// per scenario if there are several. Arguments as in RobustTuning and Tuning; `unsettled`: empty
/// if the changes that help are unknown.
std::vector<Finding> evaluation_findings(const std::vector<EvaluatedGains>& evaluated,
                                         const std::vector<EvaluatedGains>& evaluated_by_scenario,
                                         const std::vector<EvaluatedGoal>& goals,
                                         std::span<const UnsettledRuns> unsettled = {});

/// All findings of a tuning: first those of the fresh draws, then those that do not depend on the
/// draws. For nominal gains, or without fresh draws, the runs of the nominal vehicle replace those
/// on fresh draws. A part (options.shard) has only findings that do not depend on the draws;
/// merge_tune_shards() adds the others. Precondition: `tuning` is the result of tune() with
/// `options`.
std::vector<Finding> tune_findings(const Model& model, const TuneOptions& options,
                                   const Tuning& tuning);

}  // namespace awmr
