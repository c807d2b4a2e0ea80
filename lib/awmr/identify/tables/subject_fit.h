/// One resistance, surge or yaw, through every estimator. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/tables/noise_average.h"

namespace awmr {

struct SubjectFit {
  std::optional<SteadyFit> chosen;  ///< none: the rows cannot show the law, or no fit will do
  std::string why_not;              ///< why none will do; empty where the rows cannot show the law
  SteadyProblem problem;            ///< of the chosen fit
  bool log_linear = false;          ///< how it was made
  std::string method;               ///< as text
  /// The chosen fit first, then the others that the runs' errors allow; empty without a chosen one.
  std::vector<NoiseAlternative> alternatives;
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
};

/// All estimators side by side, the chosen one with its diagnostics, outliers (`outlier`),
/// influence of single rows (`influential-row`) and the verdict on the power law
/// (`power-law-inadequate`). Under squared loss gross outliers are set aside before the fit, at most
/// a tenth of the runs and at least one.
SubjectFit fit_subject(Subject subject, const SubjectOptions& options);

}  // namespace awmr
