#include "awmr/identify/coastdown/coast_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/coastdown/coast_noise.h"
#include "awmr/identify/coastdown/coast_problem.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

/// Computes d x/d theta: how the fitted numbers x depend on the free coordinates theta of the surge
/// law, which the fit keeps fixed. x: ln m', the filter's time constant if there is a filter, and
/// the initial states. With the residuals e and their Jacobian J by x, J^T e = 0 at the optimum for
/// every theta. To first order this gives d x/d theta = -J^+ d e/d theta (J^+: pseudo-inverse). The
/// dead zone has no effect, because the motors are off.
std::optional<Eigen::MatrixXd> by_surge_law(CoastProblem& problem, const Eigen::MatrixXd& j,
                                            const SteadyFit& surge) {
  Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(j.cols(), rows_of(surge.free));
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
  const Eigen::MatrixXd moves = -PivotedQr(j).solve(by_theta);
  if (!moves.allFinite()) return std::nullopt;
  for (std::size_t i = 0; i < places.size(); ++i) {
    derivative.col(places[i]) = moves.col(eigen_index(i));
  }
  return derivative;
}

bool is_finite(const CoastFit& fit) {
  return std::isnormal(std::exp(fit.log_mass_norm)) && std::isfinite(fit.variance) &&
         std::isfinite(fit.beta_variance) && fit.dof > 0.0 && std::isfinite(fit.dof);
}

/// Marks the fit as unusable, because a residual of its curves or an element of their Jacobian is
/// not finite.
CoastFit not_finite(CoastFit fit, const CoastProblem& problem) {
  fit.usable = false;
  if (converged(problem.summary())) fit.stop_reason = kNotFinite;
  return fit;
}

/// The parameters b1, c1/a1 and q1/a1 that the family has.
std::vector<TransformedParameter> shapes_of(Family family) {
  const FamilyTerms terms = terms_of(family);
  std::vector<TransformedParameter> shapes;
  if (terms.beta) shapes.push_back(TransformedParameter::kBeta);
  if (terms.coulomb) shapes.push_back(TransformedParameter::kCoulomb);
  if (terms.quadratic) shapes.push_back(TransformedParameter::kQuadratic);
  return shapes;
}

/// Initial guess of the curve g1(u)/a1 = c1/a1 + u^b1 + (q1/a1) u^2. ln a1 is 0.
TransformedParameters start_of(Family family, const Interval& beta_range) {
  constexpr double kTermOverAlpha = 0.1;
  const FamilyTerms terms = terms_of(family);
  return {0.0, terms.beta ? std::clamp(0.8, beta_range.lo, beta_range.hi) : 1.0,
          terms.coulomb ? kTermOverAlpha : 0.0, terms.quadratic ? kTermOverAlpha : 0.0, 0.0};
}

Interval range_of(TransformedParameter shape, const Interval& beta_range) {
  constexpr double kMaxOverAlpha = 1e9;
  return shape == TransformedParameter::kBeta ? beta_range : Interval{0.0, kMaxOverAlpha};
}

bool is_inside(const Interval& range, double value) {
  constexpr double kOnTheEdge = 1e-9;
  return value > range.lo + kOnTheEdge && value < range.hi - kOnTheEdge;
}

/// Sets the ratios c1/a1 and q1/a1, and the variances of ln m', b1 and these ratios. `inside`: the
/// parameters that are not at a bound; a parameter at a bound gets the variance 0. The first rows
/// of `covariance` are those of ln m' and of the parameters `inside`, in this order.
void add_shapes(CoastProblem& problem, const std::vector<TransformedParameter>& free,
                const std::vector<TransformedParameter>& inside, const Eigen::MatrixXd& covariance,
                CoastFit& fit) {
  fit.variance = covariance(0, 0);
  for (const TransformedParameter c : free) {
    const auto place = std::find(inside.begin(), inside.end(), c);
    const Eigen::Index column = 1 + (place - inside.begin());
    const double variance = place == inside.end() ? 0.0 : covariance(column, column);
    if (c == TransformedParameter::kBeta) {
      fit.beta_variance = variance;
    } else {
      fit.terms.push_back({c, *problem.block(c), variance});
    }
  }
}

}  // namespace

CoastFit fit_coast(const std::vector<CoastCurve>& curves, const SteadyFit& surge,
                   const CoastStart& start) {
  const bool terms = surge.law().coulomb > 0.0 || surge.law().quadratic > 0.0;
  CoastProblem problem(curves, surge.theta, start, terms);
  problem.solve();
  CoastFit fit;
  fit.log_mass_norm = *problem.log_mass();
  fit.stop_reason = stop_reason(problem.summary());
  fit.beta = surge[TransformedParameter::kBeta];
  const std::optional<Eigen::VectorXd> e = problem.residuals();
  const std::optional<Eigen::MatrixXd> j = problem.jacobian(problem.own_blocks());
  if (!e || !j) return not_finite(std::move(fit), problem);
  const Eigen::MatrixXd covariance = add_coast_noise(*j, *e, curves, fit);
  if (covariance.size() == 0 || !converged(problem.summary())) return fit;
  fit.variance = covariance(0, 0);
  const std::optional<Eigen::MatrixXd> by_surge = by_surge_law(problem, *j, surge);
  if (!by_surge || !is_finite(fit)) return not_finite(std::move(fit), problem);
  fit.by_surge = by_surge->row(0);
  if (start.lag_s > 0.0) fit.lag = {*problem.lag_s(), covariance(1, 1), by_surge->row(1)};
  fit.usable = true;
  return fit;
}

std::optional<CoastStart> flat_direction(const std::vector<CoastCurve>& curves,
                                         const SteadyFit& surge, const CoastFit& fit) {
  constexpr double kStandardErrors = 3.0;
  // Smallest accepted rise of the sum of squares, as a fraction of the predicted rise. If the rise
  // is smaller, the true interval of ln m' is clearly wider than the standard error says.
  constexpr double kShare = 0.5;
  const bool terms = surge.law().coulomb > 0.0 || surge.law().quadratic > 0.0;
  double best = 0.0;
  for (const std::vector<double>& run : fit.residuals) {
    for (const double e : run) best += e * e;
  }
  double least = best + kShare * std::pow(kStandardErrors * fit.residual_std_mps, 2);
  std::optional<CoastStart> flat;
  for (const double side : {-kStandardErrors, kStandardErrors}) {
    CoastProblem problem(curves, surge.theta,
                         {fit.log_mass_norm + side * std::sqrt(fit.variance), fit.lag->value_s},
                         terms);
    problem.problem().SetParameterBlockConstant(problem.log_mass());
    problem.solve();
    const std::optional<Eigen::VectorXd> e = problem.residuals();
    if (!e || e->squaredNorm() > least) continue;
    least = e->squaredNorm();
    flat = CoastStart{*problem.log_mass(), *problem.lag_s()};
  }
  return flat;
}

CoastFit fit_coast_alone(const std::vector<CoastCurve>& curves, const Interval& beta_range,
                         Family family) {
  const std::vector<TransformedParameter> free = shapes_of(family);
  const TransformedParameters start = start_of(family, beta_range);
  const Resistance<double> law{1.0, start[1], 0.0, start[2], start[3]};
  const FamilyTerms terms = terms_of(family);
  CoastProblem problem(curves, start, {guess_log_mass(curves, law)},
                       terms.coulomb || terms.quadratic);
  for (const TransformedParameter c : free) {
    const Interval range = range_of(c, beta_range);
    problem.problem().SetParameterBlockVariable(problem.block(c));
    problem.problem().SetParameterLowerBound(problem.block(c), 0, range.lo);
    problem.problem().SetParameterUpperBound(problem.block(c), 0, range.hi);
  }
  problem.solve();
  CoastFit fit;
  fit.family = family;
  fit.log_mass_norm = *problem.log_mass();
  fit.beta = *problem.block(TransformedParameter::kBeta);
  fit.stop_reason = stop_reason(problem.summary());
  std::vector<double*> blocks{problem.log_mass()};
  std::vector<TransformedParameter> inside;  // parameters that are not at a bound
  for (const TransformedParameter c : free) {
    if (!is_inside(range_of(c, beta_range), *problem.block(c))) continue;
    blocks.push_back(problem.block(c));
    inside.push_back(c);
  }
  const std::optional<Eigen::MatrixXd> j = problem.jacobian(blocks);
  const std::optional<Eigen::VectorXd> e = problem.residuals();
  if (!e || !j) return not_finite(std::move(fit), problem);
  const Eigen::MatrixXd covariance = add_coast_noise(*j, *e, curves, fit);
  if (covariance.size() == 0 || !converged(problem.summary())) return fit;
  add_shapes(problem, free, inside, covariance, fit);
  const std::size_t on_a_bound = free.size() - inside.size();
  fit.aicc = aicc(e->squaredNorm(), static_cast<double>(e->size()),
                  static_cast<double>(j->cols()) + static_cast<double>(on_a_bound));
  if (!is_finite(fit)) return not_finite(std::move(fit), problem);
  fit.usable = true;
  return fit;
}

}  // namespace awmr
