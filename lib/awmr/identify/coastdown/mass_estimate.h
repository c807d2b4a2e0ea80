/// Estimate of ln m' with its sources of error, from one trial or several. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/coastdown/derived.h"

namespace awmr {

/// ln m' with two independent errors: that of the surge law, common to all coast-downs, and its
/// own.
struct MassEstimate {
  double log_mass_norm = 0.0;
  Eigen::VectorXd by_surge;   ///< d ln m' by SteadyFit::free of the surge fit
  double own_variance = 0.0;  ///< of ln m', independent of the surge fit; >= 0
  double own_dof = 1e9;       ///< degrees of freedom of that variance; 1e9: a known variance
  std::string method;         ///< "stop time", "coast-down curve", "stop time and coast-down curve"

  /// The variance of ln m'; empty if the surge fit has no covariance.
  std::optional<double> variance(const SteadyFit& surge) const;
  /// Satterthwaite: V^2 / (V_surge^2/dof_surge + V_own^2/dof_own)
  double dof(const SteadyFit& surge) const;
};

MassEstimate from_stop_time(const MassFromStopTime& mass, std::size_t runs);
MassEstimate from_curve(const CoastFit& fit);

/// w a + (1 - w) b with minimum variance; the error of the surge fit is common to a and b.
/// Precondition: the surge fit has a covariance.
MassEstimate combined(const MassEstimate& a, const MassEstimate& b, const SteadyFit& surge);

/// `estimates-disagree` if two estimates differ significantly (p < 0.01).
std::vector<Finding> disagreement(const MassEstimate& a, const MassEstimate& b,
                                  const SteadyFit& surge, const std::string& file);

/// An estimate as an entry of /estimates. `noise`: text of the assumed errors.
EstimatorReport report_of(const MassEstimate& mass, const SteadyFit& surge, Estimator estimator,
                          std::string_view noise);

}  // namespace awmr
