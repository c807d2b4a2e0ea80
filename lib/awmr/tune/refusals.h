/// Errors for searches that find no gains. Each error points to the limit to relax, by its JSON
/// pointer in tune.json (TuneOptions::file). Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/search.h"

namespace awmr {

/// Error if no gains meet the constraints that need no simulation. `nearest`: the gains with the
/// smallest violation. The message names the constraint that they violate most, and each change of
/// a single limit or bound in `requested` that alone permits gains.
tl::unexpected<Error> infeasible(const Candidate& nearest, const ConstraintContext& context,
                                 const TuneOptions& requested);

/// Error if no gains meet the limits that need simulated runs. The message names what the gains
/// with the smallest violation miss most: a goal, an activity limit or a constraint.
tl::unexpected<Error> not_found(const SearchResult& found, const Objective& objective,
                                const ConstraintContext& context, const TuneOptions& requested);

/// Error if gains meet every limit but none of the `runs` runs settles. The message names the
/// `changes` with which runs settle.
tl::unexpected<Error> never_settles(const Gains<double>& gains, std::size_t runs,
                                    const std::vector<SettlingChange>& changes,
                                    const TuneOptions& requested);

}  // namespace awmr
