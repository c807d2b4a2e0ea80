#include "awmr/identify/coastdown/coast_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/coastdown/coast_noise.h"
#include "awmr/identify/coastdown/coast_problem.h"

namespace awmr {
namespace {

/// d ln m' / d theta of the surge law, by SteadyFit::free. At the optimum J^T e = 0 for every
/// theta, so d(ln m', initial states)/d theta = -J^+ d e/d theta; a dead zone does not enter: the
/// motors are off.
std::optional<Eigen::VectorXd> by_surge_law(CoastProblem& problem, const Eigen::MatrixXd& j,
                                            const SteadyFit& surge) {
  Eigen::VectorXd derivative = Eigen::VectorXd::Zero(rows_of(surge.free));
  std::vector<double*> blocks;
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < surge.free.size(); ++i) {
    if (surge.free[i] == TransformedParameter::kDeadZone) continue;
    blocks.push_back(problem.block(surge.free[i]));
    places.push_back(eigen_index(i));
  }
  const std::optional<Eigen::MatrixXd> all = problem.jacobian(blocks);
  if (!all) return std::nullopt;
  const Eigen::MatrixXd by_theta = all->leftCols(rows_of(blocks));
  const Eigen::MatrixXd moves = -j.colPivHouseholderQr().solve(by_theta);
  if (!moves.allFinite()) return std::nullopt;
  for (std::size_t i = 0; i < places.size(); ++i) derivative(places[i]) = moves(0, eigen_index(i));
  return derivative;
}

/// m' and its variance are numbers that a model can hold.
bool is_finite(const CoastFit& fit) {
  return std::isnormal(std::exp(fit.log_mass_norm)) && std::isfinite(fit.variance) &&
         std::isfinite(fit.beta_variance) && fit.dof > 0.0 && std::isfinite(fit.dof);
}

/// The fit as one that cannot be used, with the reason of the search where that has one.
CoastFit not_finite(CoastFit fit, const CoastProblem& problem) {
  fit.usable = false;
  if (converged(problem.summary())) fit.stop_reason = kNotFinite;
  return fit;
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
  const std::optional<Eigen::VectorXd> e = problem.residuals();
  const std::optional<Eigen::MatrixXd> j = problem.jacobian({problem.log_mass()});
  if (!e || !j) return not_finite(std::move(fit), problem);
  const Eigen::MatrixXd covariance = add_coast_noise(*j, *e, problem.sizes(), fit);
  if (covariance.size() == 0 || !converged(problem.summary())) return fit;
  fit.variance = covariance(0, 0);
  std::optional<Eigen::VectorXd> by_surge = by_surge_law(problem, *j, surge);
  if (!by_surge || !is_finite(fit)) return not_finite(std::move(fit), problem);
  fit.by_surge = std::move(*by_surge);
  fit.usable = true;
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
  const std::optional<Eigen::MatrixXd> j = problem.jacobian(blocks);
  const std::optional<Eigen::VectorXd> e = problem.residuals();
  if (!e || !j) return not_finite(std::move(fit), problem);
  const Eigen::MatrixXd covariance = add_coast_noise(*j, *e, problem.sizes(), fit);
  if (covariance.size() == 0 || !converged(problem.summary())) return fit;
  fit.variance = covariance(0, 0);
  if (!at_bound) fit.beta_variance = covariance(1, 1);
  if (!is_finite(fit)) return not_finite(std::move(fit), problem);
  fit.usable = true;
  return fit;
}

}  // namespace awmr
