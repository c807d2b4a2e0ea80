#include "awmr/identify/tables/steady_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/tables/robust.h"
#include "awmr/identify/tables/steady_search.h"

namespace awmr {
namespace {

constexpr double kAtBound = 1e-9;

bool is_at(double bound, double value) {
  return std::isfinite(bound) && std::abs(value - bound) <= kAtBound;
}

double condition_of(const Eigen::MatrixXd& jacobian) {
  const Eigen::VectorXd singular = singular_values(jacobian);
  const double least = jacobian.rows() >= jacobian.cols() ? singular(singular.size() - 1) : 0.0;
  return least > 0.0 ? singular(0) / least : std::numeric_limits<double>::infinity();
}

/// Sets rank, condition number, leverages and covariance of `fit` at the point where `search`
/// ended. Returns false if a residual, an element of its Jacobian or one of the results is not
/// finite.
bool add_uncertainty(const SteadyProblem& problem, SteadySearch& search, SteadyFit& fit) {
  const Eigen::Index n = rows_of(problem.points);
  fit.condition_number = std::numeric_limits<double>::infinity();
  fit.degrees_of_freedom = static_cast<int>(n - rows_of(fit.free));
  const std::optional<Eigen::MatrixXd> all = search.jacobian(coordinates_of(problem.family));
  std::optional<Eigen::VectorXd> residuals = search.residuals();
  const std::optional<Eigen::MatrixXd> of_free = search.jacobian(fit.free);
  if (!all || !residuals || !of_free) return false;
  fit.condition_number = condition_of(*all);
  fit.residuals = std::move(*residuals);
  const Eigen::MatrixXd& used = *of_free;
  const auto p = used.cols();
  const PivotedQr qr(used);
  fit.rank = static_cast<int>(qr.rank());
  if (fit.rank < p) return true;
  fit.leverages = qr.leverages();
  if (fit.degrees_of_freedom <= 0) return fit.leverages.allFinite();
  const bool robust = problem.loss != Loss::kSquared;
  const double variance =
      robust ? m_estimate_variance(search.loss(), fit.residuals, static_cast<int>(p))
             : fit.residuals.squaredNorm() / fit.degrees_of_freedom;
  fit.residual_std = std::sqrt(variance);
  fit.covariance = variance * qr.inverse_information();
  return std::isfinite(variance) && fit.covariance.allFinite() && fit.leverages.allFinite();
}

/// The families that are special cases of `family`, with a term fixed at 0 or the exponent at 1.
std::vector<Family> families_inside(Family family) {
  switch (family) {
    case Family::kPower:
    case Family::kCoulombLinear:
      return {};
    case Family::kCoulombLinearQuadratic:
      return {Family::kCoulombLinear};
    case Family::kCoulombPower:
      return {Family::kPower, Family::kCoulombLinear};
    case Family::kDeadZone:
      return {Family::kPower};
    case Family::kDeadZoneCoulomb:
      return {Family::kDeadZone, Family::kCoulombPower};
  }
  return {};
}

/// Initial guess from the points. alpha and beta: by the log-linear fit (beta 1 in families without
/// a free exponent). Coulomb friction or dead zone: half of the smallest force. Quadratic term: 0.
TransformedParameters initial_guess_of(const SteadyProblem& problem) {
  const SteadyFit line = fit_log_linear(problem.points);
  TransformedParameters guess{line[TransformedParameter::kLogAlpha], 1.0, 0.0, 0.0, 0.0};
  const FamilyTerms terms = terms_of(problem.family);
  if (terms.beta) guess[at(TransformedParameter::kBeta)] = line[TransformedParameter::kBeta];
  double minimum_force = std::numeric_limits<double>::infinity();
  for (const SteadyPoint& point : problem.points) {
    minimum_force = std::min(minimum_force, point.force);
  }
  if (terms.coulomb) guess[at(TransformedParameter::kCoulomb)] = 0.5 * minimum_force;
  if (terms.dead_zone) guess[at(TransformedParameter::kDeadZone)] = 0.5 * minimum_force;
  if (terms.quadratic) guess[at(TransformedParameter::kQuadratic)] = 0.0;
  return guess;
}

}  // namespace

std::vector<TransformedParameter> coordinates_of(Family family) {
  const FamilyTerms terms = terms_of(family);
  std::vector<TransformedParameter> free{TransformedParameter::kLogAlpha};
  if (terms.beta) free.push_back(TransformedParameter::kBeta);
  if (terms.coulomb) free.push_back(TransformedParameter::kCoulomb);
  if (terms.quadratic) free.push_back(TransformedParameter::kQuadratic);
  if (terms.dead_zone) free.push_back(TransformedParameter::kDeadZone);
  return free;
}

double value_from(TransformedParameter c, double coordinate) {
  if (c == TransformedParameter::kLogAlpha) return std::exp(coordinate);
  if (c == TransformedParameter::kDeadZone) return coordinate / 4.0;
  return coordinate;
}

Interval values_from(TransformedParameter c, const Interval& coordinate) {
  return {value_from(c, coordinate.lo), value_from(c, coordinate.hi)};
}

double jacobian_of(TransformedParameter c, double coordinate) {
  if (c == TransformedParameter::kLogAlpha) return std::exp(coordinate);
  return c == TransformedParameter::kDeadZone ? 0.25 : 1.0;
}

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

bool is_physical(const Resistance<double>& law) {
  return std::isnormal(law.alpha) && std::isfinite(law.beta) && std::isfinite(law.coulomb) &&
         std::isfinite(law.quadratic);
}

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
    fit.covariance = variance * qr.inverse_information();
  }
  return fit;
}

SteadyFit fit_steady(const SteadyProblem& problem, std::map<Family, TransformedParameters>& known) {
  SteadyFit best = fit_steady(problem, initial_guess_of(problem));
  for (const Family inner : families_inside(problem.family)) {
    if (!known.contains(inner)) {
      SteadyProblem simpler = problem;
      simpler.family = inner;
      fit_steady(simpler, known);
    }
    SteadyFit fit = fit_steady(problem, known.at(inner));
    const bool better = fit.residuals.squaredNorm() < best.residuals.squaredNorm();
    if (fit.usable && (!best.usable || better)) best = std::move(fit);
  }
  known[problem.family] = best.theta;
  return best;
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
    if (held) fit.at_bound.push_back(c);
    if (!held || c != TransformedParameter::kBeta) fit.free.push_back(c);
  }
  const bool finite = add_uncertainty(problem, search, fit) && is_physical(fit.law());
  if (!finite) {
    fit.covariance.resize(0, 0);
    fit.residual_std = 0.0;
    if (converged(search.summary())) fit.stop_reason = kNotFinite;
  }
  fit.usable =
      finite && converged(search.summary()) && fit.rank == static_cast<int>(fit.free.size());
  return fit;
}

std::optional<SteadyProblem> by_time(SteadyProblem problem) {
  for (SteadyPoint& point : problem.points) {
    if (!point.travel || !point.elapsed_s) return std::nullopt;
    point.elapsed_s = *point.travel / point.rate;
  }
  problem.noise = ErrorModel::kTime;
  return problem;
}

std::optional<SteadyRows> steady_rows(const SteadyProblem& problem,
                                      const TransformedParameters& theta,
                                      const std::vector<TransformedParameter>& by) {
  SteadySearch search(problem, theta, std::nullopt);
  std::optional<Eigen::VectorXd> residuals = search.residuals();
  std::optional<Eigen::MatrixXd> jacobian = search.jacobian(by);
  if (!residuals || !jacobian) return std::nullopt;
  return SteadyRows{std::move(*residuals), std::move(*jacobian)};
}

}  // namespace awmr
