/// Findings on the limits of a comparison.
#pragma once

#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/model/record.h"
#include "awmr/simulate/validity.h"

namespace awmr {

/// Findings that are the same for a part and for the whole comparison: requests that the vehicle
/// cannot meet, tyres that differ from those of the trials, too few samples (`few-samples`),
/// heading commands that are not rate-limited, and the treatment of scrub (`scrub-simulated`,
/// `turned-by-sides`). `rate` is the requested limit of the heading rate.
std::vector<Finding> compare_findings(const Model& model, const std::vector<Scenario>& scenarios,
                                      const CompareOptions& options, const Comparison& comparison,
                                      const HeadingRateChoice& rate);

/// Returns a warning (`beyond-trials`) for the fastest-turning run of a comparison; empty if no run
/// turns clearly faster than the yaw-resistance trials. `provenance` is that of the comparison.
std::vector<Finding> extrapolation_findings(const Comparison& comparison,
                                            const Provenance& provenance);

}  // namespace awmr
