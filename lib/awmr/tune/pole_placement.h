/// Gains by pole placement from the model, without simulation: start of the search and baseline of
/// its objective. Private to tune/.
#pragma once

#include "awmr/model/gains.h"
#include "awmr/tune/constraints.h"

namespace awmr {

/// The fastest poles that the constraints allow. Inside the boundary layer the heading loop is
/// (s + lambda)(s + k), k = mu/eps, and the speed loop s + k_s, k_s = mu_s/eps_s:
///   lambda, k   the pair with the largest lambda that meets every constraint, over the ratios lambda/k from the
///               largest that T2 < T1 allows (margin, strict; twice that, paper) down to a 64th of
///               it
///   k_s         min(limit/value) of speed gain and speed lag at k_s = 1
///   mu, mu_s    the smallest that meet "mu dominates" and "mu_s dominates"
/// If no pair meets every constraint, the pair with the smallest violation is returned.
Gains<double> place_poles(const ConstraintContext& context);

/// The same poles with boundary layers that contain the initial errors of the scenarios, S = lambda
/// e and e_u = u_d. The loops are then linear except for the actuators:
///   mu >= lambda k e,   mu_s >= k_s u_d,   e the largest step
Gains<double> with_wide_layers(Gains<double> gains, const ConstraintContext& context);

/// Multiplies lambda, mu/epsilon and the layer S = lambda e by `share`; the speed gains are
/// unchanged.
Gains<double> slowed(Gains<double> gains, double share);

}  // namespace awmr
