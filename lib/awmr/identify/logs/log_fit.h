/// Output-error fit of the whole model to driving logs. Private to identify/.
///
/// The model is simulated with the logged commands and compared with all measurements, in windows
/// with separate initial states. The noise of each channel is estimated from its residuals, and
/// errors that are correlated in time are whitened.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "awmr/identify/logs/channel_noise.h"
#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/model/record.h"

namespace awmr {

struct LogFit {
  std::vector<FreeQuantity> quantities;
  std::vector<double> coordinates;  ///< by quantity
  Eigen::MatrixXd covariance;  ///< of the coordinates; non-identifiable ones have a large variance
  std::vector<std::string> why_not;  ///< by quantity; empty where the logs show it
  NoiseLevels noise;
  ErrorsByChannel errors;  ///< raw, at the optimum
  /// By candidate term of the options: decrease of -2 ln L with the term free (score test).
  std::vector<double> suspect_gain;
  double widened = 1.0;    ///< largest of Identifiability's factors
  EstimatorReport report;  ///< parameters by quantity
  bool usable = false;     ///< the search converged
};

/// Precondition: an initial guess for every parameter.
/// Without measurements or free quantities, or if all searches fail, the fit is not usable and has
/// no quantities; its report has the reason.
LogFit fit_logs(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// The options with exactly the terms of the fit free, starting at its optimum; unchanged if the
/// fit has no quantities.
LogFitOptions with_terms_of(const LogFit& fit, LogFitOptions options);

/// All parameters after the fit: fitted or fixed.
ParameterValues<double> fitted_values(const LogFitOptions& options, const LogFit& fit);

}  // namespace awmr
