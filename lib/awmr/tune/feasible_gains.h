/// Searches gains that meet the constraints which can be evaluated without a simulation. Private to
/// tune/.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "awmr/tune/constraints.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Searches gains within the bounds that meet all constraints which can be evaluated without a
/// simulation. Starts from `baseline`, then from other points, until it finds such gains. If it
/// finds none, it returns the gains with the smallest violation: the largest violation of a
/// constraint counts.
Candidate feasible_start(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& baseline);

/// As feasible_start(), but searches only from `gains`.
Candidate feasible_near(const TuneOptions& options, const ConstraintContext& context,
                        const Gains<double>& gains);

/// Returns gains within the bounds that meet all constraints without a simulation, except those
/// named in `relaxed`. Among such gains, it selects those that violate the constraints in `relaxed`
/// least. Searches from `baseline`, then from other points. Returns empty if it finds none.
std::optional<Gains<double>> least_relaxed(const TuneOptions& options,
                                           const ConstraintContext& context,
                                           const Gains<double>& baseline,
                                           std::span<const std::string> relaxed);

}  // namespace awmr
