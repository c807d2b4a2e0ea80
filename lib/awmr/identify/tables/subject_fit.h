/// Fits of the surge or yaw table by all estimators, and the choice of one. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/tables/noise_average.h"

namespace awmr {

/// A family is significantly better than the power law if its AICc is lower than that of the power
/// law by at least this. A difference of 10 is a likelihood ratio of e^5.
inline constexpr double kTablesPlainlyBetter = 10.0;

/// Result of fit_subject().
struct SubjectFit {
  /// The chosen fit. Absent if no fit is accepted, or if the rows cannot determine the resistance
  /// law, which needs two different forces with different rates.
  std::optional<SteadyFit> chosen;
  /// Why no fit is accepted. Empty if a fit was chosen or the rows cannot determine the law.
  std::string refusal_reason;
  SteadyProblem problem;    ///< input of the chosen fit
  bool log_linear = false;  ///< the chosen fit is log-linear
  std::string method;       ///< description of the method
  /// The chosen fit, followed by the fits under the other error models (noise_average.h). Empty
  /// without a chosen fit.
  std::vector<NoiseAlternative> alternatives;
  /// Fits between which the rows do not decide: the chosen family under the error model by which
  /// the families are compared, then each family whose AICc is less than kTablesPlainlyBetter above
  /// it. Empty if the families were not compared.
  std::vector<FamilyCandidate> undecided;
  /// Fits of all families under the most probable error model (SubjectFit::alternatives), the chosen
  /// family first. Empty if the families were not compared.
  std::vector<FamilyCandidate> compared;
  /// True if the chosen law does not describe the rows: another family than the power law describes
  /// them much better (`power-law-inadequate`), or left and right turns differ (`turns-differ`).
  /// The values that follow from the law then get no intervals, because the wrong law, not the
  /// measurements, determines their errors.
  bool is_inadequate = false;
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
};

/// Fits the table by all estimators and chooses one. Checks the chosen fit for outliers
/// (`outlier`), influential rows (`influential-row`) and a better family (`power-law-inadequate`).
/// Before the fit, excludes gross outliers: at most a tenth of the runs, or one run if there are
/// fewer than 20. Excludes none with a robust loss or options.keeps_outliers.
SubjectFit fit_subject(Subject subject, const SubjectOptions& options);

}  // namespace awmr
