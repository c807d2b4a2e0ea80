/// Active constraints of the tuned gains, and ranges of equally good gains. Private to tune/.
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
  /// Range of mu, rad/s^2, with mu/epsilon constant, in which the objective is at most
  /// kIndifferent/2 worse than the best.
  Interval mu;
  /// Range of mu_s, m/s^2, with the smallest mu and mu_s/epsilon_s constant, in which the objective
  /// is at most kIndifferent worse than the best.
  Interval speed_mu;
};

/// Selects the smallest mu, then the smallest mu_s, that meets every constraint and has an
/// objective at most kIndifferent/2 (mu) or kIndifferent (mu_s) worse than that of `best` on the
/// draws of the search; mu/epsilon and mu_s/epsilon_s stay constant. Only these ratios act inside
/// the boundary layers, so without this rule the seed of the search would determine mu. The
/// selected gains are those of `best` if the smaller mu and mu_s violate a constraint on the draws
/// of `all`.
SettledGains settle(const TuneOptions& options, const ConstraintContext& context,
                    const Objective& searched, const Objective& all, const Candidate& best);

/// Returns the constraints that are active at `best` (residual within 1 % of the limit), each with
/// the improvement of the objective in a local search that relaxes it by kWider. Errors: those of
/// search().
Result<std::vector<ActiveConstraint>> active_constraints(const TuneOptions& options,
                                                         const ConstraintContext& context,
                                                         const Objective& objective,
                                                         const Candidate& best);

}  // namespace awmr
