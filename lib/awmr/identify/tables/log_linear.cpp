#include <cmath>
#include <limits>

#include "awmr/core/linear_algebra.h"
#include "awmr/identify/tables/steady_fit.h"

namespace awmr {
namespace {

/// Covariance of the coefficients of the fitted line ln f = ln alpha + beta ln w, s^2 (P^T P)^-1 =
/// s^2 Pi R^-1 R^-T Pi^T. P is the matrix of the rows (1, ln w), Pi the column permutation of its
/// factors P Pi = Q R, s^2 the variance of the residuals.
Eigen::Matrix2d covariance_of(const PivotedQr& qr, double variance) {
  const Eigen::Matrix2d r = qr.r();
  const Eigen::Matrix2d r_inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d p = qr.permutation();
  return variance * (p * r_inverse * r_inverse.transpose() * p.transpose());
}

}  // namespace

SteadyFit fit_log_linear(const std::vector<SteadyPoint>& points) {
  const Eigen::Index n = rows_of(points);
  Eigen::MatrixXd design(n, 2);
  Eigen::VectorXd observed(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SteadyPoint& point = points[at(i)];
    design.row(i) << 1.0, std::log(point.rate);
    observed(i) = std::log(point.force);
  }
  const PivotedQr qr(design);
  const Eigen::VectorXd singular = singular_values(design);
  SteadyFit fit;
  fit.free = coordinates_of(Family::kPower);
  fit.rank = static_cast<int>(qr.rank());
  fit.condition_number = n > 1 && singular(1) > 0.0 ? singular(0) / singular(1)
                                                    : std::numeric_limits<double>::infinity();
  fit.stop_reason = "linear problem, solved by QR";
  if (fit.rank < 2) return fit;
  const Eigen::VectorXd theta = qr.solve(observed);
  fit[TransformedParameter::kLogAlpha] = theta(0);
  fit[TransformedParameter::kBeta] = theta(1);
  fit.usable = is_physical(fit.law());
  if (!fit.usable) {
    fit.stop_reason = "failed: the curve through the logarithms is not finite";
    return fit;
  }
  fit.residuals = design * theta - observed;
  fit.leverages = qr.leverages();
  fit.degrees_of_freedom = static_cast<int>(n) - 2;
  if (fit.degrees_of_freedom > 0) {
    const double variance = fit.residuals.squaredNorm() / fit.degrees_of_freedom;
    fit.residual_std = std::sqrt(variance);
    fit.covariance = covariance_of(qr, variance);
  }
  return fit;
}

}  // namespace awmr
