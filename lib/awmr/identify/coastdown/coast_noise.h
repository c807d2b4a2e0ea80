/// Noise of coast-down curves, and the resulting uncertainty of the estimates. Private to
/// identify/coastdown/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"

namespace awmr {

/// Splits the residuals into runs of these sizes.
std::vector<std::vector<double>> by_run(const Eigen::VectorXd& e, const std::vector<int>& sizes);

/// Fills the residuals, their level and correlation, rank and degrees of freedom of `fit` from the
/// jacobian `j` and the residuals `e` at the optimum. Returns the covariance over the columns of
/// `j`, which allows for errors correlated from sample to sample; 0 x 0 without full rank or
/// degrees of freedom.
Eigen::MatrixXd add_coast_noise(const Eigen::MatrixXd& j, const Eigen::VectorXd& e,
                                const std::vector<int>& sizes, CoastFit& fit);

}  // namespace awmr
