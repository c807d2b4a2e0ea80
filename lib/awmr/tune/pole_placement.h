/// Gains by pole placement, computed from the model without simulation. They are the default start
/// and the default baseline of the search. Private to tune/.
#pragma once

#include <array>

#include "awmr/model/gains.h"
#include "awmr/tune/constraints.h"

namespace awmr {

/// Returns the gains with the fastest poles that the constraints allow. Inside the boundary layer,
/// the heading loop has the poles -lambda and -k, k = mu/eps, and the speed loop the pole -k_s, k_s
/// = mu_s/eps_s:
///   lambda, k   the pair with the largest lambda that meets every constraint. Ratios lambda/k from
///               the largest that T2 < T1 allows (strict: margin; paper: 2 margin) down to a 64th
///               of it are tried.
///   k_s         the largest that meets "speed gain" and "speed lag"
///   mu, mu_s    the smallest that meet "mu dominates" and "mu_s dominates"
/// If no pair meets every constraint, the pair with the smallest violation is returned. The gains
/// have the given observer (default: none), which the constraints include.
Gains<double> place_poles(const ConstraintContext& context,
                          const ObserverGains<double>& observer = {});

/// Returns two initial guesses of the search: first, the result of place_poles() with wider
/// boundary layers, which contain the initial errors (the poles stay the same); second, the
/// unchanged result. The default bounds of the gains follow from these two.
std::array<Gains<double>, 2> starting_poles(const ConstraintContext& context,
                                            const ObserverGains<double>& observer = {});

/// Multiplies lambda, mu/epsilon and epsilon by `share`, so that the heading loop is slower for
/// `share` < 1. The speed gains are unchanged.
Gains<double> slowed(Gains<double> gains, double share);

}  // namespace awmr
