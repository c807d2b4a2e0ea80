/// m' and I'z from coast-downs, by stop times, curves or both. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/coastdown/derived.h"
#include "awmr/identify/tables/subject_fit.h"

namespace awmr {

/// ln m' with its sources of error: the surge law's and its own.
struct MassEstimate {
  double log_mass_norm = 0.0;
  Eigen::VectorXd by_surge;   ///< by SteadyFit::free of the surge fit
  double own_variance = 0.0;  ///< of ln m', independent of the surge fit
  double own_dof = 1e9;       ///< degrees of freedom of that variance
  std::string method;         ///< "stop time", "coast-down curve", "stop time and coast-down curve"

  /// Of ln m'; none where the surge fit has no covariance.
  std::optional<double> variance(const SteadyFit& surge) const;
  /// Satterthwaite: V^2 / (V_surge^2/dof_surge + V_own^2/dof_own)
  double dof(const SteadyFit& surge) const;
};

struct MassResult {
  std::optional<MassEstimate> estimate;
  std::optional<JointFit> joint;  ///< where asked for and usable
  std::optional<CoastFit> alone;  ///< curves without a surge law
  std::string reason;             ///< why there is no estimate
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
};

/// Precondition: at least a stop time or a curve. `surge` is absent where its law is not
/// identified.
MassResult estimate_mass(const SubjectFit* surge, const std::optional<TrialSet<StopTimeRow>>& stops,
                         const std::vector<CoastCurve>& curves, const Vehicle& vehicle, bool joint);

}  // namespace awmr
