/// Refusals of a search: what keeps every gain from being taken, and the limit to relax. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/search.h"

namespace awmr {

/// No gains meet the constraints that need no run: names the one that the nearest gains break most.
tl::unexpected<Error> infeasible(const Candidate& nearest, const ConstraintContext& context);

/// No gains meet what runs are needed for: names the goal, the activity or the constraint that the nearest
/// break most.
tl::unexpected<Error> not_found(const SearchResult& found, const Objective& objective,
                                const std::vector<Scenario>& scenarios);

/// Gains that meet every limit but with which no run settles: names the limit that costs the most, and
/// --observer where friction at rest holds the vehicle off its heading.
tl::unexpected<Error> never_settles(const Gains<double>& gains, std::size_t runs,
                                    const std::vector<ActiveConstraint>& active, bool is_held);

}  // namespace awmr
