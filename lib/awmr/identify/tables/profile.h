/// Profile-likelihood intervals of table fits, and AICc, which compares resistance families.
/// Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {

/// 95 % profile-likelihood interval of the coordinate `c`. At each end of the interval, the
/// smallest sum of squares with `c` fixed there is t^2 s^2 above that of `fit`, with the residual
/// standard deviation s and the 97.5 % quantile t of Student's t. The interval ends at the bounds
/// of `c` at the latest. Precondition: squared loss, degrees of freedom, `c` free.
Interval profile_interval(const SteadyProblem& problem, const SteadyFit& fit,
                          TransformedParameter c);

/// AICc of a fit. An exponent at a bound counts as a free parameter.
std::optional<double> aicc(const SteadyFit& fit);

}  // namespace awmr
