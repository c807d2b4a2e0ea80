/// Findings (notes and warnings) of a comparison, for the output of `awmr compare`.
#pragma once

#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/model/record.h"
#include "awmr/simulate/validity.h"

namespace awmr {

/// Returns the findings that do not depend on the results of the runs. They concern
///   - requests that the vehicle cannot meet, and heading commands without rate limit,
///   - tyres that differ from those of the trials, and parameters without interval,
///   - too few samples (`few-samples`),
///   - tyre scrub (`scrub-simulated`, `turned-by-sides`).
/// A part of a comparison has the same findings as the whole comparison. `rate`: requested limit of
/// the heading rate.
std::vector<Finding> compare_findings(const Model& model, const std::vector<Scenario>& scenarios,
                                      const CompareOptions& options, const Comparison& comparison,
                                      const HeadingRateChoice& rate);

/// Returns the warning `incomplete-if-changed` for each scenario and change (other plant, slower or
/// faster gains) that makes a mode fail: without the change, the mode completes some runs; with the
/// change, none.
std::vector<Finding> completion_findings(const Comparison& comparison);

/// Returns the warning `beyond-trials` if a run turns faster than 1.2 times the highest yaw rate of
/// the trials from which yaw resistance was identified. The warning is about the run with the
/// highest yaw rate. Empty if no run turns so fast, or if the yaw rate of the trials is unknown.
/// `provenance`: origin of the comparison (its input files).
std::vector<Finding> extrapolation_findings(const Comparison& comparison,
                                            const Provenance& provenance);

}  // namespace awmr
