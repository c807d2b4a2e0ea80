/// AIC comparison of log fits with different models under one noise model. Private to identify/.
///
/// The noise model is that of the fit with the smaller errors. Reason: each fit estimates its own
/// noise, and the drift in this noise absorbs the error of the fit's own model. If each fit used
/// its own noise model, a fit with a smooth error of 0.2 m/s could be likelier than a fit with an
/// error of 3 mm/s.
#pragma once

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// AIC of a fit's errors under the noise model `noise`; smaller is better. With the innovations
/// nu_k of all channels, their variances S_k (whitener.h) and n free quantities,
///
///     AIC = sum (ln S_k + nu_k^2/S_k) + 2 n
double aic_under(const NoiseLevels& noise, const LogFit& fit);

/// AIC of `b` minus AIC of `a`, under the noise model of the fit with the smaller errors: > 0 if
/// `a` is better. Infinity if only `a` is usable, -infinity if only `b` is, 0 if neither is.
double aic_lead(const LogFit& a, const LogFit& b);

/// aic_lead() with each innovation counted as at most three standard deviations, so that a few rows
/// do not decide.
double aic_lead_of_most_rows(const LogFit& a, const LogFit& b);

}  // namespace awmr
