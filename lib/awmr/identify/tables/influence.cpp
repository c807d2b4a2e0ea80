#include "awmr/identify/tables/influence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// A run is influential if a fit without this run changes a parameter by more than this number of
/// standard errors. Such a single run changes the result by more than its reported error.
constexpr double kInfluential = 1.0;

std::optional<TransformedParameters> refit_without(std::size_t row, const Subject& subject,
                                                   const SteadyProblem& problem, bool log_linear,
                                                   const SteadyFit& fit) {
  std::vector<SteadyPoint> points = subject.points;
  points.erase(points.begin() + eigen_index(row));
  if (!has_two_forces(points)) return std::nullopt;
  SteadyFit without;
  if (log_linear) {
    without = fit_log_linear(points);
  } else {
    SteadyProblem rest = problem;
    rest.points = std::move(points);
    without = fit_steady(rest, fit.theta);
  }
  if (!without.usable) return std::nullopt;
  return without.theta;
}

/// Approximates the fit without run i by one Gauss-Newton step from the fit of all runs, whose
/// coordinates are theta:
///   theta_(i) = theta + (J^T J)^-1 j_i e_i/(1 - h_i),   e = curve - measured      [Cook 1977]
/// with row j_i of the Jacobian J, the residual e_i and the leverage h_i (weight of run i in its
/// own fitted value). The step is exact for a log-linear fit.
class OneStep {
 public:
  OneStep(const SteadyProblem& problem, bool log_linear, const SteadyFit& fit)
      : problem_(problem), fit_(fit) {
    const double variance = fit.residual_std * fit.residual_std;
    // Not available with a robust loss, because the step does not include its weights of the rows.
    if (!fit.has_covariance() || !(variance > 0.0) || problem.loss != Loss::kSquared) return;
    inverse_ = fit.covariance / variance;
    if (log_linear) {
      jacobian_.resize(rows_of(problem.points), 2);
      for (Eigen::Index i = 0; i < jacobian_.rows(); ++i) {
        jacobian_.row(i) << 1.0, std::log(problem.points[at(i)].rate);
      }
    } else if (std::optional<SteadyRows> rows = steady_rows(problem, fit.theta, fit.free)) {
      jacobian_ = std::move(rows->jacobian);
    }
  }

  /// Coordinates of the fit without the run `row`. Empty if only this run determines a parameter,
  /// or if the fit has no Jacobian.
  std::optional<TransformedParameters> without(std::size_t row) const {
    constexpr double kAlone = 1e-12;
    const Eigen::Index i = eigen_index(row);
    if (jacobian_.rows() == 0 || !(1.0 - fit_.leverages(i) > kAlone)) return std::nullopt;
    const Eigen::VectorXd step =
        inverse_ * jacobian_.row(i).transpose() * (fit_.residuals(i) / (1.0 - fit_.leverages(i)));
    TransformedParameters theta = fit_.theta;
    for (std::size_t k = 0; k < fit_.free.size(); ++k) {
      const TransformedParameter c = fit_.free[k];
      const Interval bounds = bounds_of(problem_, c);
      theta[at(c)] = std::clamp(theta[at(c)] + step(eigen_index(k)), bounds.lo, bounds.hi);
    }
    return theta;
  }

 private:
  const SteadyProblem& problem_;
  const SteadyFit& fit_;
  Eigen::MatrixXd inverse_;  ///< (J^T J)^-1, free x free
  /// Jacobian J, runs x free coordinates. Empty if the step is not available.
  Eigen::MatrixXd jacobian_;
};

/// Describes the parameters that change by more than kInfluential standard errors without a run:
/// "surge.alpha becomes 0.3 (from 0.25), ...". Empty if none does.
std::string what_moves(const Subject& subject, const std::vector<TransformedParameter>& coordinates,
                       const TransformedParameters& without, const SteadyFit& fit) {
  std::string moved;
  for (const TransformedParameter c : coordinates) {
    const auto error = fit.std_error(c);
    if (!error || std::abs(without[at(c)] - fit[c]) <= kInfluential * *error) continue;
    moved += fmt::format("{}{} becomes {:.4g} (from {:.4g})", moved.empty() ? "" : ", ",
                         info(parameter_of(subject, c)).name, value_from(c, without[at(c)]),
                         value_from(c, fit[c]));
  }
  return moved;
}

}  // namespace

Influence leave_one_out(const Subject& subject, const SteadyProblem& problem, bool log_linear,
                        const SteadyFit& fit) {
  Influence influence;
  const std::vector<TransformedParameter> coordinates = coordinates_of(problem.family);
  const bool refit = rows_of(subject.points) <= kExactRows;
  const std::optional<OneStep> one_step =
      refit ? std::nullopt : std::optional<OneStep>(std::in_place, problem, log_linear, fit);
  for (std::size_t i = 0; i < subject.points.size(); ++i) {
    const std::optional<TransformedParameters> rest =
        refit ? refit_without(i, subject, problem, log_linear, fit) : one_step->without(i);
    if (!rest) continue;
    const TransformedParameters& without = *rest;
    LeaveOneOut entry{subject.file, subject.points[i].line, {}};
    for (const TransformedParameter c : coordinates) {
      entry.values.push_back(value_from(c, without[at(c)]));
    }
    if (!std::ranges::all_of(entry.values, [](double x) { return std::isfinite(x); })) continue;
    const std::string moved = what_moves(subject, coordinates, without, fit);
    if (!moved.empty()) {
      influence.findings.push_back({subject.file, entry.line, Severity::kNote, "influential-row",
                                    "without this run, " + moved + "; repeat the run to check it"});
    }
    influence.without.push_back(std::move(entry));
  }
  return influence;
}

bool has_two_forces(const std::vector<SteadyPoint>& points) {
  constexpr double kSame = 1e-9;
  return std::any_of(points.begin(), points.end(), [&](const SteadyPoint& p) {
    return std::abs(p.force - points.front().force) > kSame * points.front().force;
  });
}

}  // namespace awmr
