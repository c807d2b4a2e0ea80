/// Noise of coast-down curves and the covariance of their fits. Private to identify/coastdown/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"

namespace awmr {

/// Splits the residuals `e` of all runs by run. `sizes`: number of samples of each run.
std::vector<std::vector<double>> by_run(const Eigen::VectorXd& e, const std::vector<int>& sizes);

/// Sets the residuals, their standard deviation and autocorrelation, the rank and the degrees of
/// freedom of `fit`, from the Jacobian `j` and the residuals `e` at the optimum. Returns the
/// covariance of the parameters of the columns of `j`, which allows for errors that are correlated
/// from sample to sample. The covariance is 0 x 0 if `j` has no full rank or there are no degrees
/// of freedom.
Eigen::MatrixXd add_coast_noise(const Eigen::MatrixXd& j, const Eigen::VectorXd& e,
                                const std::vector<int>& sizes, CoastFit& fit);

}  // namespace awmr
