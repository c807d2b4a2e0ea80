#include "awmr/identify/tables/steady_fit.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/index.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/tables/robust.h"
#include "awmr/identify/tables/steady_search.h"

namespace awmr {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAtBound = 1e-9;

bool is_at(double bound, double value) {
  return std::isfinite(bound) && std::abs(value - bound) <= kAtBound;
}

/// Residuals and Jacobian at the solution -> rank, condition, leverages, covariance.
void add_uncertainty(const SteadyProblem& problem, SteadySearch& search, SteadyFit& fit) {
  const Eigen::Index n = rows_of(problem.points);
  const Eigen::MatrixXd all = search.jacobian(coordinates_of(problem.family));
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(all).singularValues();
  const double least = n >= all.cols() ? singular(singular.size() - 1) : 0.0;
  fit.condition_number = least > 0.0 ? singular(0) / least : kInfinity;
  fit.residuals = search.residuals();
  const Eigen::MatrixXd used = search.jacobian(fit.free);
  const auto p = used.cols();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(used);
  fit.rank = static_cast<int>(qr.rank());
  fit.degrees_of_freedom = static_cast<int>(n - p);
  if (fit.rank < p) return;
  fit.leverages = Eigen::MatrixXd(qr.householderQ()).leftCols(p).rowwise().squaredNorm();
  if (fit.degrees_of_freedom <= 0) return;
  const bool robust = problem.loss != Loss::kSquared;
  const double variance =
      robust ? m_estimate_variance(search.loss(), fit.residuals, static_cast<int>(p))
             : fit.residuals.squaredNorm() / fit.degrees_of_freedom;
  fit.residual_std = std::sqrt(variance);
  // sigma^2 (J^T J)^-1, from the pseudo-inverse J^+: J^+ J^+T
  const Eigen::MatrixXd inverse = qr.solve(Eigen::MatrixXd::Identity(n, n));
  fit.covariance = variance * inverse * inverse.transpose();
}

/// Without another fit: the power law by QR, then a share of the minimum force for each new term.
TransformedParameters initial_guess_of(const SteadyProblem& problem) {
  const SteadyFit line = fit_log_linear(problem.points);
  TransformedParameters guess{line[TransformedParameter::kLogAlpha], 1.0, 0.0, 0.0, 0.0};
  const FamilyTerms terms = terms_of(problem.family);
  if (terms.beta) guess[at(TransformedParameter::kBeta)] = line[TransformedParameter::kBeta];
  double minimum_force = kInfinity;
  for (const SteadyPoint& point : problem.points) {
    minimum_force = std::min(minimum_force, point.force);
  }
  if (terms.coulomb) guess[at(TransformedParameter::kCoulomb)] = 0.5 * minimum_force;
  if (terms.dead_zone) guess[at(TransformedParameter::kDeadZone)] = 0.5 * minimum_force;
  if (terms.quadratic) guess[at(TransformedParameter::kQuadratic)] = 0.0;
  return guess;
}

}  // namespace

bool SteadyFit::held_by_bound(TransformedParameter c) const {
  return std::find(at_bound.begin(), at_bound.end(), c) != at_bound.end();
}

std::optional<double> SteadyFit::std_error(TransformedParameter c) const {
  const auto place = std::find(free.begin(), free.end(), c);
  if (place == free.end() || !has_covariance()) return std::nullopt;
  const auto i = place - free.begin();
  return std::sqrt(covariance(i, i));
}

Resistance<double> SteadyFit::law() const {
  return {.alpha = std::exp((*this)[TransformedParameter::kLogAlpha]),
          .beta = (*this)[TransformedParameter::kBeta],
          .coulomb = (*this)[TransformedParameter::kCoulomb],
          .quadratic = (*this)[TransformedParameter::kQuadratic]};
}

SteadyFit fit_steady(const SteadyProblem& problem) {
  return fit_steady(problem, initial_guess_of(problem));
}

SteadyFit fit_steady(const SteadyProblem& problem, const TransformedParameters& initial_guess) {
  SteadySearch search(problem, initial_guess, std::nullopt);
  search.solve();
  if (problem.loss != Loss::kSquared) search.solve_robustly();
  SteadyFit fit;
  fit.theta = search.theta();
  fit.stop_reason = stop_reason(search.summary());
  for (const TransformedParameter c : coordinates_of(problem.family)) {
    const Interval bounds = bounds_of(problem, c);
    const bool held = is_at(bounds.lo, fit[c]) || is_at(bounds.hi, fit[c]);
    (held ? fit.at_bound : fit.free).push_back(c);
  }
  add_uncertainty(problem, search, fit);
  fit.usable = converged(search.summary()) && fit.rank == static_cast<int>(fit.free.size());
  return fit;
}

SteadyRows steady_rows(const SteadyProblem& problem, const TransformedParameters& theta,
                       const std::vector<TransformedParameter>& by) {
  SteadySearch search(problem, theta, std::nullopt);
  return {search.residuals(), search.jacobian(by)};
}

}  // namespace awmr
