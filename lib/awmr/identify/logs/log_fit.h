/// Output-error fit of the whole model to driving logs. Private to identify/.
///
/// The model is driven by the logged commands and compared with everything that was measured, in
/// windows that each have their own initial state. The noise of each channel is estimated from its
/// residuals, and errors that are correlated in time are whitened.
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
/// Where nothing is measured, nothing is free or no search leads anywhere, the fit is not usable,
/// has no quantities, and its report says why.
LogFit fit_logs(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// The options with the terms of the fit free and no others, from where it found them; as they are
/// where the fit has no quantities.
LogFitOptions with_terms_of(const LogFit& fit, LogFitOptions options);

/// All parameters as the fit leaves them: the free ones fitted, the rest as they were held.
ParameterValues<double> fitted_values(const LogFitOptions& options, const LogFit& fit);

}  // namespace awmr
