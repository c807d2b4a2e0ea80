/// Result of `tune` as text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "awmr/tune/tune.h"

namespace awmr::cli {

/// Table of the tuned gains and the baseline, with time constants and objective.
std::string gains_table(const Tuning& tuning);

/// Metrics of the gains on fresh draws (newly drawn vehicles that were not used for tuning), also
/// by scenario if there are several. Empty if no fresh draws were made.
std::string evaluation_table(const std::vector<EvaluatedGains>& all,
                             const std::vector<EvaluatedGains>& by_scenario);

/// Results of the goals with the tuned gains on the fresh draws; empty without goals.
std::string goals_text(const std::vector<EvaluatedGoal>& all);

/// All tables of a tuning.
std::string tuning_summary(const Tuning& tuning, const TuneOptions& options);

/// Objective by scenario and mode, constraints, and why the search ended, for `--verbose`.
std::string tuning_details(const Tuning& tuning);

}  // namespace awmr::cli
