/// Fits of one resistance, surge or yaw, by all estimators. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/tables/noise_average.h"

namespace awmr {

struct SubjectFit {
  std::optional<SteadyFit> chosen;  ///< absent: the rows cannot determine the law, or no fit is
                                    ///< accepted
  std::string why_not;              ///< why no fit is accepted; empty if the rows cannot determine
                                    ///< the law
  SteadyProblem problem;            ///< of the chosen fit
  bool log_linear = false;          ///< the chosen fit is log-linear
  std::string method;               ///< as text
  /// The chosen fit, then those under the other noise models (noise_average.h); empty without a
  /// chosen one.
  std::vector<NoiseAlternative> alternatives;
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
};

/// Fits by all estimators. The chosen one has diagnostics, outliers (`outlier`), the influence of
/// single rows (`influential-row`) and the test of the power law (`power-law-inadequate`). Under
/// squared loss, gross outliers are excluded before the fit: at most a tenth of the runs, but at
/// least one is allowed.
SubjectFit fit_subject(Subject subject, const SubjectOptions& options);

}  // namespace awmr
