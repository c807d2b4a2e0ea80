/// Findings (notes and warnings) of a comparison, for the output of `awmr compare`.
#pragma once

#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/model/record.h"
#include "awmr/simulate/validity.h"

namespace awmr {

/// Returns the findings that do not depend on the runs, so that they are the same for a part and for
/// the whole comparison: requests that the vehicle cannot meet, tyres that differ from those of the
/// trials, too few samples (`few-samples`), heading commands without rate limit, and scrub
/// (`scrub-simulated`, `turned-by-sides`). `rate` is the requested limit of the heading rate.
std::vector<Finding> compare_findings(const Model& model, const std::vector<Scenario>& scenarios,
                                      const CompareOptions& options, const Comparison& comparison,
                                      const HeadingRateChoice& rate);

/// Returns a warning (`beyond-trials`) about the run with the highest yaw rate. Empty if no run
/// turns clearly faster than the trials that yaw resistance was identified from. `provenance` is
/// that of the comparison.
std::vector<Finding> extrapolation_findings(const Comparison& comparison,
                                            const Provenance& provenance);

}  // namespace awmr
