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

/// Default number of points from which feasible_gains() searches.
inline constexpr int kStarts = 32;
/// The same for the advice in a refusal, which repeats the search for many limits.
inline constexpr int kFewStarts = 5;

/// Searches gains within the bounds that meet all constraints which can be evaluated without a
/// simulation. Starts from `first`, then from other points, until it finds such gains, at most from
/// `starts` points. If it finds none, it returns the gains with the smallest violation: the largest
/// violation of a constraint counts.
Candidate feasible_gains(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& first, int starts = kStarts);

/// Returns gains within the bounds that meet all constraints without a simulation, except those
/// named in `relaxed`. Among such gains, it selects those that violate the constraints in `relaxed`
/// least. Searches from `first`, then from other points. Returns empty if it finds none.
std::optional<Gains<double>> least_relaxed(const TuneOptions& options,
                                           const ConstraintContext& context,
                                           const Gains<double>& first,
                                           std::span<const std::string> relaxed);

}  // namespace awmr
