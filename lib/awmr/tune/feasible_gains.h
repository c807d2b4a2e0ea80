/// Searches gains that meet the constraints that need no simulation. Private to tune/.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "awmr/tune/constraints.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns gains within the bounds that meet the constraints that need no simulation. If it finds
/// none, it returns the gains with the smallest violation. Searches from `baseline`, then from
/// other points.
Candidate feasible_start(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& baseline);

/// As feasible_start(), but searches only from `gains`.
Candidate feasible_near(const TuneOptions& options, const ConstraintContext& context,
                        const Gains<double>& gains);

/// Returns gains within the bounds that violate the constraints named in `relaxed` as little as
/// possible, and meet all other constraints that need no simulation. Empty if none are found.
/// Searches from `baseline`, then from other points.
std::optional<Gains<double>> least_relaxed(const TuneOptions& options,
                                           const ConstraintContext& context,
                                           const Gains<double>& baseline,
                                           std::span<const std::string> relaxed);

}  // namespace awmr
