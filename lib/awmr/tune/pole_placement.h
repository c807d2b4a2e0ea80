/// Gains by pole placement, from the model alone: the start of a search, and the baseline of its
/// objective.
/// Private to tune/.
#pragma once

#include "awmr/model/gains.h"
#include "awmr/tune/constraints.h"

namespace awmr {

/// The fastest poles that the constraints allow. Inside the boundary layer the heading loop is
/// (s + lambda)(s + k), k = mu/eps, and the speed loop s + k_s, k_s = mu_s/eps_s:
///   lambda, k   the pair with the largest lambda that meets every constraint, over the ratios lambda/k from the
///               largest that T2 < T1 allows (margin, strict; twice that, paper) down to a 64th of it
///   k_s         min(limit/value) of speed gain and speed lag at k_s = 1
///   mu, mu_s    the least that dominate
/// Where no pair meets every constraint, the one that breaks them least.
Gains<double> place_poles(const ConstraintContext& context);

/// The same poles with layers that hold what the scenarios begin with, S = lambda e and e_u = u_d, so that the
/// loops are linear but for the actuators:
///   mu >= lambda k e,   mu_s >= k_s u_d,   e the largest step
Gains<double> with_wide_layers(Gains<double> gains, const ConstraintContext& context);

/// lambda, mu/epsilon and the layer S = lambda e times `share`; the speed gains stay.
Gains<double> slowed(Gains<double> gains, double share);

}  // namespace awmr
