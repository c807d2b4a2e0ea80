/// The scrub that ends a mode's lead over another. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/compare/compare.h"

namespace awmr {

/// For each scenario, and each pair of a mode with differential turns and one with less of them
/// (differential, combined, steering) of which the first has the better score without scrub: the scrub with
/// which its lead is gone. The controller knows nothing of it.
/// `comparison` holds the rows of sample 0 with one set of gains. Errors (input): as sample_plants().
Result<std::vector<BreakEven>> break_even_of(const Model& model, const Gains<double>& gains,
                                             const std::vector<Scenario>& scenarios,
                                             const Comparison& comparison,
                                             const CompareOptions& options);

/// A line for each pair of modes over all scenarios, and how to measure what decides it.
std::string break_even_table(const std::vector<BreakEven>& entries);

}  // namespace awmr
