/// The second optimum of fits with a lag: the lag and the vehicle's motion may be exchanged.
/// Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/problem/noise_iteration.h"

namespace awmr {

/// Searches from the other optimum of a fit with a lag of the motors, the servo or a sensor. If the
/// resistance is linear, the motion is a lag too, with the time constant
///
///     T = m'/(slope of the resistance, with back-EMF)   (yaw: I'z)
///
/// and two lags in series have the same effect in either order. A search may therefore end with
/// the two time constants exchanged; what is not linear, or other channels, decide. Empty if no
/// exchange lowers AIC.
std::optional<NoiseIteration> with_exchanged_lag(const NoiseIteration& settled);

/// Another optimum of a fit, with a lag and the motion exchanged.
struct ExchangedOptimum {
  std::size_t lag = 0;              ///< index of the lag among the quantities
  std::vector<double> coordinates;  ///< one per quantity
  double aic_excess = 0.0;          ///< AIC there minus AIC of the fit, under the same noise model
};

/// The other optimum, by with_exchanged_lag(), with the lowest AIC, if its AIC exceeds that of the
/// fit by less than 6 and its lag is another one. The logs then do not decide between the two: the
/// other one is at least 1/20 as likely. `optimum`: solution of `problem`.
std::optional<ExchangedOptimum> equally_likely_exchange(const LogProblem& problem,
                                                        const SearchPoint& optimum);

}  // namespace awmr
