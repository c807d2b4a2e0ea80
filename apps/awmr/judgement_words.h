/// What fresh draws say of gains, as `tune` and `merge` print it.
#pragma once

#include <string>
#include <vector>

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

}  // namespace awmr::cli
