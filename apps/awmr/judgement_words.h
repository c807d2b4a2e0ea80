/// What fresh draws say of gains, as `tune` and `merge` print it.
#pragma once

#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/model/record.h"
#include "awmr/tune/tune.h"

namespace awmr::cli {

/// What the gains do on draws that they were not tuned on, scenario by scenario where there are
/// several; empty where none were judged.
std::string judged_table(const std::vector<JudgedGains>& all,
                         const std::vector<JudgedGains>& by_scenario);

/// What fresh draws say of the goals with the tuned gains; empty without goals.
std::string goals_text(const std::vector<JudgedGoal>& all);

/// A warning where fresh draws do not show that a goal is met.
std::vector<Finding> goal_findings(const std::vector<JudgedGoal>& all);

/// Adds a warning (`unsettled`) where fewer than 95 % of the runs settle after every step.
/// `completed_share` is in [0, 1].
void note_unsettled(const std::string& scenario, YawMode mode, double completed_share,
                    std::vector<Finding>& findings);

/// The same for the tuned gains on fresh draws, scenario by scenario where there are several.
std::vector<Finding> unsettled_findings(const std::vector<JudgedGains>& all,
                                        const std::vector<JudgedGains>& by_scenario);

/// A warning (`beyond-trials`) on the run of a comparison that turns fastest; empty where none turns
/// clearly faster than yaw resistance was measured. `provenance` is the comparison's.
std::vector<Finding> extrapolation_findings(const Comparison& comparison,
                                            const Provenance& provenance);

}  // namespace awmr::cli
