/// Active constraints, and ranges of equally good gains. Private to tune/.
#pragma once

#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Gains with the ranges of mu and mu_s in which the objective is nearly constant.
struct SettledGains {
  Gains<double> gains{};
  /// mu, rad/s^2, with mu/epsilon constant and the objective within kIndifferent of the best.
  Interval mu;
  Interval speed_mu;  ///< mu_s, m/s^2, with epsilon_s in the same way
};

/// Selects the smallest mu, then the smallest mu_s, that meets every constraint and scores as
/// `best` within kIndifferent on the searched draws. With mu/epsilon constant the objective hardly
/// depends on mu, because only that ratio acts inside the boundary layer; without this rule the
/// seed would decide. Returns `best` if the selected gains violate a constraint on all draws.
SettledGains settle(const TuneOptions& options, const ConstraintContext& context,
                    const Objective& searched, const Objective& all, const Candidate& best);

/// The constraints that are active at `best` (residual within 1 %), each with the improvement of
/// the objective in a local search that relaxes it by a tenth. Errors: as search().
Result<std::vector<ActiveConstraint>> active_constraints(const TuneOptions& options,
                                                         const ConstraintContext& context,
                                                         const Objective& objective,
                                                         const Candidate& best);

}  // namespace awmr
