/// Result of `tune`, and of `merge` for its parts, as text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "awmr/tune/tune.h"

namespace awmr::cli {

/// Table of the tuned gains and the baseline, with time constants and objective.
std::string gains_table(const Tuning& tuning);

/// Metrics of the gains on draws not used for tuning, per scenario if there are several; empty
/// without fresh draws.
std::string judged_table(const std::vector<JudgedGains>& all,
                         const std::vector<JudgedGains>& by_scenario);

/// Results of the goals with the tuned gains on fresh draws; empty without goals.
std::string goals_text(const std::vector<JudgedGoal>& all);

/// All tables of a tuning.
std::string tuning_summary(const Tuning& tuning, const TuneOptions& options);

/// Scores, constraints and the end of the search, for `--verbose`.
std::string tuning_details(const Tuning& tuning);

}  // namespace awmr::cli
