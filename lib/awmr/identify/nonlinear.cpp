#include <ceres/ceres.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/identify/power_law_fit.h"

namespace awmr {
namespace {

/// The residual of one point with the error on force, speed or time, over (ln alpha, beta).
struct PowerLawResidual {
  PowerLawPoint point;
  Noise noise;

  template <class T>
  bool operator()(const T* theta, T* residual) const {
    using std::exp;
    const T& log_alpha = theta[0];
    const T& beta = theta[1];
    if (noise == Noise::kForce) {
      residual[0] = exp(log_alpha + beta * std::log(point.rate)) - point.force;
      return true;
    }
    const T log_rate = (std::log(point.force) - log_alpha) / beta;
    residual[0] = noise == Noise::kSpeed ? exp(log_rate) - point.rate
                                         : *point.travel * exp(-log_rate) - *point.elapsed_s;
    return true;
  }
};

using Cost = ceres::AutoDiffCostFunction<PowerLawResidual, 1, 2>;

/// beta has to stay above 0 where the law is inverted.
constexpr double kLeastInvertibleBeta = 1e-3;

std::string words(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return "converged: " + summary.message;
    case ceres::NO_CONVERGENCE:
      return "not converged: " + summary.message;
    default:
      return "failed: " + summary.message;
  }
}

/// Residuals and Jacobian at the solution -> rank, condition, covariance.
void add_uncertainty(const std::vector<PowerLawPoint>& points, Noise noise, const double* theta,
                     PowerLawFit& fit) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd jacobian(n, 2);
  Eigen::VectorXd residuals(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Cost cost(new PowerLawResidual{points[static_cast<std::size_t>(i)], noise});
    double row[2];
    double* rows[] = {row};
    cost.Evaluate(&theta, &residuals(i), rows);
    jacobian.row(i) << row[0], row[1];
  }
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian).singularValues();
  fit.condition_number = n > 1 && singular(1) > 0.0 ? singular(0) / singular(1)
                                                    : std::numeric_limits<double>::infinity();
  const Eigen::Index free = fit.beta_at_bound ? 1 : 2;
  const Eigen::MatrixXd used = jacobian.leftCols(free);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(used);
  fit.rank = static_cast<int>(qr.rank());
  fit.degrees_of_freedom = static_cast<int>(n - free);
  if (fit.degrees_of_freedom <= 0 || fit.rank < free) return;
  const double variance = residuals.squaredNorm() / fit.degrees_of_freedom;
  fit.residual_std = std::sqrt(variance);
  // sigma^2 (J^T J)^-1 over the free parameters, from the pseudo-inverse J^+: J^+ J^+T
  const Eigen::MatrixXd inverse = qr.solve(Eigen::MatrixXd::Identity(n, n));
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  covariance.topLeftCorner(free, free) = variance * inverse * inverse.transpose();
  fit.covariance = covariance;
}

}  // namespace

PowerLawFit fit_nonlinear(const std::vector<PowerLawPoint>& points, Noise noise,
                          const Interval& beta_range, const PowerLawFit& start) {
  const double lowest =
      noise == Noise::kForce ? beta_range.lo : std::max(beta_range.lo, kLeastInvertibleBeta);
  double theta[2] = {start.log_alpha, std::clamp(start.beta, lowest, beta_range.hi)};
  ceres::Problem problem;
  for (const PowerLawPoint& point : points) {
    problem.AddResidualBlock(new Cost(new PowerLawResidual{point, noise}), nullptr, theta);
  }
  problem.SetParameterLowerBound(theta, 1, lowest);
  problem.SetParameterUpperBound(theta, 1, beta_range.hi);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  PowerLawFit fit;
  fit.log_alpha = theta[0];
  fit.beta = theta[1];
  fit.usable = summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE;
  fit.stop_reason = words(summary);
  constexpr double kAtBound = 1e-9;
  fit.beta_at_bound = fit.beta <= lowest + kAtBound || fit.beta >= beta_range.hi - kAtBound;
  add_uncertainty(points, noise, theta, fit);
  return fit;
}

}  // namespace awmr
