/// Break-even analysis: computes the tyre scrub at which a mode is no longer better than another.
/// Scrub is the yaw moment, independent of the yaw rate, with which the tyres resist a turn by
/// wheel-force differences. Private to compare/.
#pragma once

#include <string>
#include <vector>

#include "awmr/compare/compare.h"

namespace awmr {

/// Computes, for each scenario and pair of modes, the scrub at which the first mode is no longer
/// better than the second. The first mode of a pair
///   - has larger wheel-force differences than the second (differential > combined > steering),
///   - has the better score without scrub,
///   - completes the scenario, or the second mode does not complete it either.
/// The controller does not compensate the scrub. `comparison` must contain the runs of sample 0
/// (the nominal model) with one set of gains. Errors (input): yaw resistance was identified from
/// differential turns and therefore already includes scrub; the errors of compare().
Result<std::vector<BreakEven>> break_even_of(const Model& model, const Gains<double>& gains,
                                             const std::vector<Scenario>& scenarios,
                                             const Comparison& comparison,
                                             const CompareOptions& options);

/// True if the highest yaw rate of the run is outside of the range of yaw rates at which scrub was
/// measured, by more than a factor of 1.2 (kLittleFurther). False if scrub was not measured.
bool turns_at_other_rates(const BreakEven& entry);

/// Text for a terminal: for each pair of modes the smallest break-even scrub of all scenarios, the
/// result with the measured scrub and, if scrub was not measured, the trials to record.
std::string break_even_table(const std::vector<BreakEven>& entries);

}  // namespace awmr
