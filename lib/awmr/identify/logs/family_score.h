/// Comparison of fits of different models under one noise model. Private to identify/.
///
/// Each fit estimates its own noise, and its drift absorbs the error of its model. Under their own
/// noise, a model with a smooth error of 0.2 m/s can be likelier than one with an error of 3 mm/s.
/// Models are therefore compared under the noise of the fit with the smaller errors.
#pragma once

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// AIC of a fit's errors under a given noise; smaller is better.
///
///     AIC = sum over channels (ln S_k + nu_k^2/S_k) + 2 k,   k free quantities
double aic_under(const NoiseLevels& noise, const LogFit& fit);

/// Size of the errors: sum over channels of n ln(sum e^2/n).
double log_size_of_errors(const LogFit& fit);

/// AIC of `b` minus AIC of `a` under the noise of the one with the smaller errors: > 0 if `a` is
/// better. +-infinity if only one of them is usable; 0 if neither is.
double aic_lead(const LogFit& a, const LogFit& b);

}  // namespace awmr
