/// One resistance, surge or yaw, through every estimator. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {

/// What is to be identified from which runs.
struct Subject {
  FitSubject name = FitSubject::kSurge;  ///< surge or yaw
  ParameterId alpha = ParameterId::kSurgeAlpha;
  ParameterId beta = ParameterId::kSurgeBeta;
  ParameterId coulomb = ParameterId::kSurgeCoulomb;
  ParameterId quadratic = ParameterId::kSurgeQuadratic;
  std::vector<Family> families;  ///< that make sense for it; the first is the power law
  Interval beta_range;
  std::string file;
  std::vector<SteadyPoint> points;
};

struct SubjectOptions {
  Method method = Method::kLogLinear;
  std::optional<ErrorModel> noise;
  FamilyChoice family;
  Loss loss = Loss::kSquared;
  bool side_by_side = true;
};

struct SubjectFit {
  std::optional<SteadyFit> chosen;  ///< none: the rows cannot show the law
  SteadyProblem problem;            ///< of the chosen fit
  bool log_linear = false;          ///< how it was made
  std::string method;               ///< in words
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
};

/// All estimators side by side, the chosen one with its diagnostics, outliers (`outlier`),
/// influence of single rows (`influential-row`) and the verdict on the power law
/// (`power-law-inadequate`).
SubjectFit fit_subject(const Subject& subject, const SubjectOptions& options);

/// The parameter that a coordinate of a fit is.
ParameterId parameter_of(const Subject& subject, TransformedParameter c);
/// Its value: alpha from its logarithm, F'0 = z/4.
double value_from(TransformedParameter c, double coordinate);
/// d value / d coordinate.
double jacobian_of(TransformedParameter c, double coordinate);

/// Value, standard error and 95 % interval of one coordinate: Student's t, or the given interval.
Estimate estimate_of(const SteadyFit& fit, TransformedParameter c, const std::optional<Interval>& interval,
                     const std::string& method);

}  // namespace awmr
