/// Break-even analysis: computes how much tyre scrub makes a mode lose its advantage over another.
/// Scrub is a yaw moment, independent of the yaw rate, with which the tyres resist a turn by
/// wheel-force differences. Private to compare/.
#pragma once

#include <string>
#include <vector>

#include "awmr/compare/compare.h"

namespace awmr {

/// Computes for each scenario the break-even scrub of pairs of modes: the scrub at which the first
/// mode is no longer better than the second mode. The first mode of a pair
///   - has larger wheel-force differences (differential > combined > steering),
///   - has the better score without scrub,
///   - completes the scenario without scrub, or the second mode does not complete it either.
/// The controller does not compensate the scrub. `comparison` must contain the runs of sample 0
/// (the nominal model) with one set of gains. Errors (input): yaw resistance was identified from
/// differential turns and therefore already includes scrub; the errors of compare().
Result<std::vector<BreakEven>> break_even_of(const Model& model, const ModeGains& gains,
                                             const std::vector<Scenario>& scenarios,
                                             const Comparison& comparison,
                                             const CompareOptions& options);

/// True if the run turns faster or slower than the turns in which scrub was measured: its highest
/// yaw rate is outside the measured range by more than a factor of 1.2 (kLittleFurther). False if
/// scrub was not measured at all.
bool turns_at_other_rates(const BreakEven& entry);

/// Returns the break-even analysis as text for a terminal. It has the smallest break-even scrub of
/// each pair of modes over all scenarios, and whether the first mode stays better with the measured
/// scrub. If scrub was not measured, the text names the trials to record.
std::string break_even_table(const std::vector<BreakEven>& entries);

}  // namespace awmr
