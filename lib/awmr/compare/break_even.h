/// Break-even analysis: the tyre scrub at which a mode is no longer better than another. Scrub is
/// the Coulomb yaw moment of tyres in a differential turn. Private to compare/.
#pragma once

#include <string>
#include <vector>

#include "awmr/compare/compare.h"

namespace awmr {

/// Computes, for each scenario and each pair of modes, the scrub at which the first mode is no
/// longer better than the second. Pairs are those in which the first has larger wheel-force
/// differences (differential > combined > steering) and the better score without scrub. The
/// controller does not compensate the scrub. `comparison` holds the rows of sample 0 with one set of
/// gains. Errors (input): as sample_plants().
Result<std::vector<BreakEven>> break_even_of(const Model& model, const Gains<double>& gains,
                                             const std::vector<Scenario>& scenarios,
                                             const Comparison& comparison,
                                             const CompareOptions& options);

/// True if the yaw rate of the run is outside the rates at which scrub was measured by more than a
/// factor of kLittleFurther.
bool turns_at_other_rates(const BreakEven& entry);

/// Text for a terminal: for each pair of modes the break-even scrub over all scenarios, and the
/// trials that would decide which mode is better.
std::string break_even_table(const std::vector<BreakEven>& entries);

}  // namespace awmr
