/// Profile-likelihood intervals, and AICc of a fit. Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {

/// The minimum sum of squares with one coordinate fixed. Infinite if the search fails.
double profile_cost(const SteadyProblem& problem, const TransformedParameters& initial_guess,
                    TransformedParameter held, double value);

/// Profile-likelihood interval of a coordinate: at each end the profile of the sum of squares is
/// t^2 s^2 above its minimum. An end beyond a bound is set to the bound. Precondition: squared
/// loss, degrees of freedom, `c` free.
Interval profile_interval(const SteadyProblem& problem, const SteadyFit& fit,
                          TransformedParameter c);

/// AICc; counts the free coordinates, and the exponent if it is at a bound.
std::optional<double> aicc(const SteadyFit& fit);

}  // namespace awmr
