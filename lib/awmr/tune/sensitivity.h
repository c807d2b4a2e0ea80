/// Active constraints of the tuned gains, and ranges of equally good gains. Private to tune/.
#pragma once

#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Gains with the ranges of mu and mu_s in which the objective is nearly constant. The lower ends
/// are those of `gains`.
struct SettledGains {
  Gains<double> gains{};
  /// Range of mu, rad/s^2, at constant mu/epsilon.
  Interval mu;
  /// Range of mu_s, m/s^2, at constant mu_s/epsilon_s and with the smallest mu.
  Interval speed_mu;
};

/// Reduces mu of the best gains, then mu_s, at constant mu/epsilon and mu_s/epsilon_s. Inside the
/// boundary layers only these two ratios act, so without this rule the seed of the search would
/// determine mu. Selects the smallest mu that meets every constraint and whose objective is at most
/// kIndifferent/2 worse than that of `best`, on the drawn vehicles of the search (`searched`). Then
/// selects the smallest mu_s with an objective at most kIndifferent worse.
///
/// On all drawn vehicles (`all`), the reduced gains must also meet the constraints and be at most
/// kIndifferent worse than `best`. Otherwise both reductions are made smaller (kReductions), or
/// `best` is kept.
SettledGains settle(const TuneOptions& options, const ConstraintContext& context,
                    const Objective& searched, const Objective& all, const Candidate& best);

/// Returns the constraints that are active at `best` (within 1 % of the limit). For each, a local
/// search finds by how much the objective improves if the constraint is relaxed by kWider. Errors:
/// those of search().
Result<std::vector<ActiveConstraint>> active_constraints(const TuneOptions& options,
                                                         const ConstraintContext& context,
                                                         const Objective& objective,
                                                         const Candidate& best);

}  // namespace awmr
