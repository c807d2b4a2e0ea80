/// Which quantities the logs show, and why not the others. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

struct Identifiability {
  Eigen::MatrixXd covariance;        ///< n x n, of the coordinates; 0 along open directions
  std::vector<std::string> why_not;  ///< by quantity; empty where the logs show it
  int rank = 0;                      ///< directions that the logs show
  double condition_number = 0.0;     ///< of the Jacobian, coordinates over their large changes
};

/// Directions v of the coordinates over their large changes, from the information's eigenvectors. A
/// direction is shown where its standard error is below a half; an open one takes along every
/// quantity that has a tenth or more of its squared length. A quantity may be open on its own too.
Identifiability identifiability(const Eigen::MatrixXd& information,
                                const std::vector<FreeQuantity>& quantities);

/// A coordinate that the search left at an end of its range was stopped there, not found; and an
/// exponent without its factor says nothing.
Identifiability without_stopped(Identifiability found, const LogProblem& problem,
                                const std::vector<double>& coordinates);

}  // namespace awmr
