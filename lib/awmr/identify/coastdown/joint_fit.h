/// Surge rows and coast-down curves as one fit. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"

namespace awmr {

/// Joint fit of surge rows and curves, each weighted by its estimated noise.
struct JointFit {
  SteadyFit surge;             ///< theta, free, covariance of the joint optimum
  double log_mass_norm = 0.0;  ///< ln m'
  Eigen::MatrixXd covariance;  ///< over (surge.free, ln m'), positive definite
  Eigen::VectorXd dof;         ///< Satterthwaite's, by element of the same
  CoastFit coast;              ///< its residuals, noise, stop reason, and whether it is usable
};

/// `alone`: the fit of the surge rows alone, which is the initial guess of the joint one.
JointFit fit_joint(const SteadyProblem& surge, const SteadyFit& alone,
                   const std::vector<CoastCurve>& curves);

}  // namespace awmr
