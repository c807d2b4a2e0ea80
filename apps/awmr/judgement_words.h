/// Validation of gains on fresh draws, as printed by `tune` and `merge`.
#pragma once

#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/model/record.h"
#include "awmr/tune/tune.h"

namespace awmr::cli {

/// Metrics of the gains on draws not used for tuning, per scenario if there are several; empty
/// without validation.
std::string judged_table(const std::vector<JudgedGains>& all,
                         const std::vector<JudgedGains>& by_scenario);

/// Results of the goals with the tuned gains on fresh draws; empty without goals.
std::string goals_text(const std::vector<JudgedGoal>& all);

/// Returns a warning for each goal that the fresh draws do not confirm.
std::vector<Finding> goal_findings(const std::vector<JudgedGoal>& all);

/// Adds a warning (`unsettled`) where fewer than 95 % of the runs settle after every step.
/// `completed_share` is in [0, 1].
void note_unsettled(const std::string& scenario, YawMode mode, double completed_share,
                    std::vector<Finding>& findings);

/// The same for the tuned gains on fresh draws, per scenario if there are several.
std::vector<Finding> unsettled_findings(const std::vector<JudgedGains>& all,
                                        const std::vector<JudgedGains>& by_scenario);

/// Returns a warning (`beyond-trials`) for the fastest-turning run of a comparison; empty if no run
/// turns clearly faster than the yaw-resistance trials. `provenance` is that of the comparison.
std::vector<Finding> extrapolation_findings(const Comparison& comparison,
                                            const Provenance& provenance);

}  // namespace awmr::cli
