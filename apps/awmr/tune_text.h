/// Result of `tune` as text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "awmr/tune/tune.h"

namespace awmr::cli {

/// Table of the tuned gains and the baseline, with time constants and objective.
std::string gains_table(const Tuning& tuning);

/// All tables of a tuning.
std::string tuning_summary(const Tuning& tuning, const TuneOptions& options);

/// Text for `--verbose`: objective by scenario and mode, constraints, why the search ended.
std::string tuning_details(const Tuning& tuning);

}  // namespace awmr::cli
