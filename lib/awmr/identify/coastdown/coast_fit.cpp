#include "awmr/identify/coastdown/coast_fit.h"

#include <Eigen/QR>
#include <algorithm>

#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/coastdown/coast_noise.h"
#include "awmr/identify/coastdown/coast_problem.h"

namespace awmr {
namespace {

/// d ln m' / d theta of the surge law, by SteadyFit::free. At the optimum J^T e = 0 for every
/// theta, so d(ln m', initial states)/d theta = -J^+ d e/d theta; a dead zone does not enter: the
/// motors are off.
Eigen::VectorXd by_surge_law(CoastProblem& problem, const Eigen::MatrixXd& j,
                             const SteadyFit& surge) {
  Eigen::VectorXd derivative = Eigen::VectorXd::Zero(rows_of(surge.free));
  std::vector<double*> blocks;
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < surge.free.size(); ++i) {
    if (surge.free[i] == TransformedParameter::kDeadZone) continue;
    blocks.push_back(problem.block(surge.free[i]));
    places.push_back(eigen_index(i));
  }
  const Eigen::MatrixXd by_theta = problem.jacobian(blocks).leftCols(rows_of(blocks));
  const Eigen::MatrixXd moves = -j.colPivHouseholderQr().solve(by_theta);
  for (std::size_t i = 0; i < places.size(); ++i) derivative(places[i]) = moves(0, eigen_index(i));
  return derivative;
}

}  // namespace

CoastFit fit_coast(const std::vector<CoastCurve>& curves, const SteadyFit& surge) {
  const bool terms = surge.law().coulomb > 0.0 || surge.law().quadratic > 0.0;
  CoastProblem problem(curves, surge.theta, guess_log_mass(curves, surge.law()), terms);
  problem.solve();
  CoastFit fit;
  fit.log_mass_norm = *problem.log_mass();
  fit.stop_reason = stop_reason(problem.summary());
  fit.beta = surge[TransformedParameter::kBeta];
  const Eigen::VectorXd e = problem.residuals();
  const Eigen::MatrixXd j = problem.jacobian({problem.log_mass()});
  const Eigen::MatrixXd covariance = add_coast_noise(j, e, problem.sizes(), fit);
  if (covariance.size() == 0 || !converged(problem.summary())) return fit;
  fit.variance = covariance(0, 0);
  fit.usable = true;
  fit.by_surge = by_surge_law(problem, j, surge);
  return fit;
}

CoastFit fit_coast_alone(const std::vector<CoastCurve>& curves, const Interval& beta_range) {
  const TransformedParameters unit{0.0, std::clamp(0.8, beta_range.lo, beta_range.hi), 0.0, 0.0,
                                   0.0};
  CoastProblem problem(curves, unit, guess_log_mass(curves, {1.0, unit[1]}), false);
  double* beta = problem.block(TransformedParameter::kBeta);
  ceres::Problem& ceres = problem.problem();
  ceres.SetParameterBlockVariable(beta);
  ceres.SetParameterLowerBound(beta, 0, beta_range.lo);
  ceres.SetParameterUpperBound(beta, 0, beta_range.hi);
  problem.solve();
  CoastFit fit;
  fit.log_mass_norm = *problem.log_mass();
  fit.beta = *beta;
  fit.stop_reason = stop_reason(problem.summary());
  constexpr double kAtBound = 1e-9;
  const bool at_bound =
      fit.beta <= beta_range.lo + kAtBound || fit.beta >= beta_range.hi - kAtBound;
  std::vector<double*> blocks{problem.log_mass()};
  if (!at_bound) blocks.push_back(beta);
  const Eigen::MatrixXd covariance =
      add_coast_noise(problem.jacobian(blocks), problem.residuals(), problem.sizes(), fit);
  if (covariance.size() == 0 || !converged(problem.summary())) return fit;
  fit.variance = covariance(0, 0);
  if (!at_bound) fit.beta_variance = covariance(1, 1);
  fit.usable = true;
  return fit;
}

}  // namespace awmr
