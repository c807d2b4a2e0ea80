/// Fits of different models compared by their simulated errors. Private to identify/.
///
/// Each fit estimates its own noise, and a drift absorbs whatever its model misses: under its own
/// noise, a model that misses by a smooth 0.2 m/s can look likelier than one that misses by 3 mm/s.
/// Models are therefore compared under one noise, that of the fit with the smaller errors.
#pragma once

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Akaike's criterion of a fit's errors under a given noise; less is better.
///
///     AIC = sum over channels (ln S_k + nu_k^2/S_k) + 2 k,   k free quantities
double aic_under(const NoiseLevels& noise, const LogFit& fit);

/// Logarithmic size of the errors: sum over channels n ln(sum e^2/n).
double log_size_of_errors(const LogFit& fit);

/// AIC of `b` less AIC of `a` under the noise of the one with the smaller errors: above 0 where `a` is
/// better. Infinite where only one of them is usable; 0 where neither is.
double aic_lead(const LogFit& a, const LogFit& b);

}  // namespace awmr
