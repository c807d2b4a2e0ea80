/// Robust losses and the covariance of fits with them. Private to identify/.
#pragma once

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <memory>

#include "awmr/identify/options.h"

namespace awmr {

/// Ceres loss function for residuals with the standard deviation `scale`. Thresholds: Huber 1.345,
/// Cauchy 2.385, Tukey 4.685 standard deviations. If the noise is normal, the variance of the
/// estimates is then that of least squares divided by 0.95. Null for Loss::kSquared.
std::unique_ptr<ceres::LossFunction> make_loss(Loss loss, double scale);

/// Robust estimate of the standard deviation of normal residuals e: 1.4826 median |e|.
double median_scale(const Eigen::VectorXd& residuals);

/// Variance that multiplies (J^T J)^-1 in the covariance of an M-estimate [Huber 1981, 7.6]:
///   kappa^2 [sum psi^2/(n - p)] / [mean psi']^2,  kappa = 1 + (p/n) var(psi')/mean(psi')^2
/// for n residuals and p parameters. psi: derivative of the loss with respect to the residual;
/// psi': its second derivative.
double m_estimate_variance(const ceres::LossFunction& loss, const Eigen::VectorXd& residuals,
                           int parameters);

}  // namespace awmr
