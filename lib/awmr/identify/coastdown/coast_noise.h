/// Noise of coast-down curves and the covariance of their fits. Private to identify/coastdown/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/logs/problem/channel_noise.h"

namespace awmr {

/// Splits the residuals `e`, which are stored curve after curve, into one list per curve.
std::vector<std::vector<double>> by_run(const Eigen::VectorXd& e,
                                        const std::vector<CoastCurve>& curves);

/// Most likely noise of the residuals `e`: white noise and, if significant, a drift
/// (likeliest_noise()). `free`: number of fitted parameters. `sensor_mps`: white noise of the
/// readings.
ChannelNoise noise_of_residuals(const Eigen::VectorXd& e, const std::vector<CoastCurve>& curves,
                                int free, double sensor_mps);

/// -2 ln L of the residuals `e` under the noise model `noise`, up to a constant (cost_of()).
double cost_of_residuals(const Eigen::VectorXd& e, const std::vector<CoastCurve>& curves,
                         const ChannelNoise& noise);

/// Returns the standard deviation of white noise that gives the mean error of all samples in
/// `curves` the same variance as `noise` does; at least noise.std(). Where `noise` is correlated,
/// this value is larger than noise.std(), because averaging then removes less of the noise.
double effective_std(const ChannelNoise& noise, const std::vector<CoastCurve>& curves);

/// Completes `fit` from the Jacobian `j` and the residuals `e` at the optimum: sets the residuals,
/// their standard deviation and autocorrelation, the rank, the condition number and the degrees of
/// freedom. Returns the covariance of the parameters, in the order of the columns of `j`. The
/// covariance includes the effect of a drift of the errors (noise_of_residuals()). Returns a 0 x 0
/// matrix if `j` is rank-deficient or there are no degrees of freedom.
Eigen::MatrixXd add_coast_noise(const Eigen::MatrixXd& j, const Eigen::VectorXd& e,
                                const std::vector<CoastCurve>& curves, CoastFit& fit);

}  // namespace awmr
