/// Break-even analysis: tyre scrub at which a mode is no longer better than another. Private to
/// this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/compare/compare.h"

namespace awmr {

/// For each scenario, and each pair of modes of which the first has larger wheel-force differences
/// (differential > combined > steering) and the better score without scrub: the scrub at which it
/// is no longer better. The controller does not compensate the scrub. `comparison` holds the rows
/// of sample 0 with one set of gains. Errors (input): as sample_plants().
Result<std::vector<BreakEven>> break_even_of(const Model& model, const Gains<double>& gains,
                                             const std::vector<Scenario>& scenarios,
                                             const Comparison& comparison,
                                             const CompareOptions& options);

/// True if the run turns at rates outside those of the scrub measurement by more than the allowed
/// extrapolation.
bool turns_at_other_rates(const BreakEven& entry);

/// One line for each pair of modes over all scenarios, and the trials that decide it.
std::string break_even_table(const std::vector<BreakEven>& entries);

}  // namespace awmr
