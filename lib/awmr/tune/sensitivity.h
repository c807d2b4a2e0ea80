/// Active constraints, and ranges of equally good gains. Private to tune/.
#pragma once

#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Gains with what of them the objective leaves open.
struct SettledGains {
  Gains<double> gains{};
  /// Range in which mu and epsilon can be scaled together while the objective rises by at most
  /// kIndifferent.
  Interval mu;
  Interval speed_mu;  ///< the same of mu_s and epsilon_s
};

/// The objective hardly depends on mu while mu/epsilon stays: inside the boundary layer that ratio
/// alone acts. So that the search's seed does not decide, the least mu is taken that scores as well as
/// `best` within kIndifferent on the searched draws and meets every constraint, then the least mu_s;
/// `best` itself where they do not hold on all draws.
SettledGains settle(const TuneOptions& options, const ConstraintContext& context,
                    const Objective& searched, const Objective& all, const Candidate& best);

/// The constraints within 1 % of which `best` is, and how far the objective falls in a local search
/// from there where one of them may be broken by a tenth. Errors: as search().
Result<std::vector<ActiveConstraint>> active_constraints(const TuneOptions& options,
                                                         const ConstraintContext& context,
                                                         const Objective& objective,
                                                         const Candidate& best);

}  // namespace awmr
