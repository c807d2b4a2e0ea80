/// Joint fit of surge rows and coast-down curves (--joint). Private to identify/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"

namespace awmr {

/// Result of the joint fit. The fit weights surge rows and curves by their estimated noise.
struct JointFit {
  SteadyFit surge;             ///< the surge law at the joint optimum, with its covariance
  double log_mass_norm = 0.0;  ///< ln m'
  /// Covariance of the coordinates surge.free and ln m', positive definite.
  Eigen::MatrixXd covariance;
  Eigen::VectorXd dof;  ///< effective degrees of freedom (Satterthwaite) of surge.free, ln m'
  CoastFit coast;       ///< residuals and noise of the curves; stop reason; usable or not
};

/// Fits the rows of the surge runs and the coast-down curves together. `alone`: fit of the surge
/// rows alone, the initial guess of the surge law. `start`: initial guess of m' and, if the speed
/// sensor has a filter, of its time constant. If the search fails, `coast.usable` is false and the
/// stop reasons are set.
JointFit fit_joint(const SteadyProblem& surge, const SteadyFit& alone,
                   const std::vector<CoastCurve>& curves, const CoastStart& start);

}  // namespace awmr
