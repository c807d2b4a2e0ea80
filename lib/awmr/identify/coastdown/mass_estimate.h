/// Estimates of ln m' from coast-downs, with their errors, and the combination of two estimates.
/// Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/coastdown/derived.h"

namespace awmr {

/// An estimate of ln m' with two independent errors: one from the surge law, which all coast-downs
/// share, and one from the coast-down itself.
struct MassEstimate {
  double log_mass_norm = 0.0;
  Eigen::VectorXd by_surge;   ///< d ln m' / d theta, theta: SteadyFit::free of the surge fit
  double own_variance = 0.0;  ///< variance of ln m' from the coast-down itself, >= 0
  double own_dof = 1e9;       ///< degrees of freedom of own_variance; 1e9: variance known exactly
  std::string method;         ///< "stop time", "coast-down curve", "stop time and coast-down curve"

  /// Total variance of ln m'; empty if the surge fit has no covariance.
  std::optional<double> variance(const SteadyFit& surge) const;
  /// Effective degrees of freedom (Satterthwaite) of the total variance V of ln m'. V is the sum of
  /// two variances: V_surge, due to the surge law, and V_own, due to the coast-down itself:
  ///   V^2 / (V_surge^2/dof_surge + V_own^2/dof_own),   V = V_surge + V_own
  double dof(const SteadyFit& surge) const;
};

MassEstimate from_stop_time(const MassFromStopTime& mass, std::size_t runs);
MassEstimate from_curve(const CoastFit& fit);

/// Weighted mean w a + (1 - w) b of two estimates of ln m'; w minimises its variance. The errors of
/// a and b due to the surge fit are correlated, because both use the same fit. Precondition: the
/// surge fit has a covariance.
MassEstimate combined(const MassEstimate& a, const MassEstimate& b, const SteadyFit& surge);

/// The warning `estimates-disagree` if the estimates a and b differ significantly (p < 0.01 by a
/// two-sided normal test); else no finding.
std::vector<Finding> disagreement(const MassEstimate& a, const MassEstimate& b,
                                  const SteadyFit& surge, const std::string& file);

/// Report of an estimate for /estimates of model.json. `noise`: names of the quantities that have a
/// measurement error.
EstimatorReport report_of(const MassEstimate& mass, const SteadyFit& surge, Estimator estimator,
                          std::string_view noise);

}  // namespace awmr
