/// Intervals from the profile of the sum of squares, and the criterion that compares families.
/// Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {

/// The minimum sum of squares with one coordinate held. Infinite where the search fails.
double profile_cost(const SteadyProblem& problem, const TransformedParameters& initial_guess,
                    TransformedParameter held, double value);

/// Profile-likelihood interval of a coordinate: the profile of the sum of squares rises by t^2 s^2
/// on either side; an end that a bound cuts off lies on the bound. Precondition: squared loss,
/// degrees of freedom, `c` free.
Interval profile_interval(const SteadyProblem& problem, const SteadyFit& fit,
                          TransformedParameter c);

/// AICc over the free coordinates, and the exponent where a bound holds it.
std::optional<double> aicc(const SteadyFit& fit);

}  // namespace awmr
