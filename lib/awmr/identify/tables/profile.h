/// Profile-likelihood intervals and AICc of table fits. Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {

/// 95 % profile-likelihood interval of the coordinate `c`. At each end, the smallest sum of squares
/// with `c` fixed there is t^2 s^2 above that of `fit`. s is the residual standard deviation, t the
/// 97.5 % quantile of Student's t. An end beyond a bound is set to the bound. Precondition: squared
/// loss, degrees of freedom, `c` free.
Interval profile_interval(const SteadyProblem& problem, const SteadyFit& fit,
                          TransformedParameter c);

/// AICc of a fit. An exponent at a bound counts as a free parameter.
std::optional<double> aicc(const SteadyFit& fit);

}  // namespace awmr
