#include "awmr/identify/logs/checks/held_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/logs/choice/further_terms.h"
#include "awmr/identify/logs/problem/identifiability.h"
#include "awmr/identify/logs/problem/information.h"
#include "awmr/identify/logs/problem/log_problem.h"

namespace awmr {
namespace {

/// The least-squares problem of these rows of a log, with the noise levels that `fit` has estimated
/// from other rows.
LogProblem problem_of(const std::vector<DrivingLog>& rows, const LogFit& fit,
                      const LogFitOptions& options) {
  LogProblem problem = log_problem(rows, options);
  set_noise(fit.noise, problem);
  problem.model.longest_step_s = step_s_at(problem.model, fit.coordinates);
  return problem;
}

/// Makes one Gauss-Newton step of the initial states of the windows, with fixed fitted quantities.
/// `states`: one column for each window. Returns the largest decrease of a window's cost that the
/// step predicts.
double step_initial_states(const std::vector<WindowSums>& sums, Eigen::Index coordinates,
                           Eigen::Map<Eigen::MatrixXd> states) {
  const Eigen::Index n = coordinates;
  const Eigen::Index k = states.rows();
  double largest = 0.0;
  for (std::size_t w = 0; w < sums.size(); ++w) {
    const Eigen::VectorXd gradient = sums[w].products.block(n, n + k, k, 1);
    const Eigen::VectorXd step = solve_ldlt(sums[w].products.block(n, n, k, k), gradient);
    states.col(eigen_index(w)) -= step;
    largest = std::max(largest, 0.5 * gradient.dot(step));
  }
  return largest;
}

/// Fits the initial states of all windows, with fixed fitted quantities. Gauss-Newton steps from
/// the measured states suffice, because the motion is nearly linear in the states (except for a
/// servo at its rate limit). The steps end when no state changes by more than 0.1 standard errors.
/// Smaller steps hardly change the gradient of ln L, and they may alternate without end in a window
/// in which the vehicle rests.
SearchPoint with_initial_states(const LogProblem& problem, std::vector<double> coordinates) {
  constexpr int kSteps = 10;
  // Cost of a step of 0.1 standard errors; a step of d gains d^2/2.
  constexpr double kSmall = 0.5 * 0.1 * 0.1;
  const Eigen::Index n = rows_of(coordinates);
  const Eigen::Index k = rows_of(problem.model.initial);
  SearchPoint point = from_measured(problem, std::move(coordinates));
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<WindowSums> sums = sums_at(problem, point);
    if (!all_finite(sums)) break;
    const Eigen::Map<Eigen::MatrixXd> states(point.initial_states.data(), k, rows_of(sums));
    if (step_initial_states(sums, n, states) < kSmall) break;
  }
  return point;
}

/// Indices of the coordinates to compare, and of the biases, which may differ between parts of a
/// log. Coordinates at an end of their range are left out.
struct Places {
  std::vector<Eigen::Index> compared;
  std::vector<Eigen::Index> biases;
};

Places places_of(const LogProblem& problem, const std::vector<double>& coordinates) {
  Places places;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const Interval& range = problem.bounds[i];
    if (coordinates[i] <= range.lo || coordinates[i] >= range.hi) continue;
    const bool is_bias = problem.model.quantities[i].kind == FreeQuantity::Kind::kBias;
    (is_bias ? places.biases : places.compared).push_back(eigen_index(i));
  }
  return places;
}

/// Information and score of the compared coordinates c, each in units of its large change
/// (FreeQuantity::large_change). Eliminates the biases b: with information H and score S of all
/// coordinates, the result is H_cc - H_cb H_bb^-1 H_bc and S_c - H_cb H_bb^-1 S_b.
FitEvidence scaled_evidence(const std::vector<WindowSums>& sums, const Eigen::VectorXd& scale,
                            const Places& places) {
  const FitEvidence all = fit_evidence(sums, scale.size());
  const auto& c = places.compared;
  const auto& b = places.biases;
  const Eigen::MatrixXd h = scale.asDiagonal() * all.information * scale.asDiagonal();
  const Eigen::VectorXd s = scale.asDiagonal() * all.score;
  if (b.empty()) return {h(c, c), s(c)};
  const Eigen::MatrixXd by_bias = solve_ldlt(h(b, b), h(b, c)).transpose();
  return {h(c, c) - by_bias * h(b, c), s(c) - by_bias * s(b)};
}

/// Change of the compared coordinates from the fit to the tested rows, each divided by its large
/// change (FreeQuantity::large_change). `directions`: number of directions that the rows determine.
struct Change {
  Eigen::VectorXd size;  ///< the change d, one number per compared coordinate
  Eigen::MatrixXd covariance;
  double p_value = 1.0;
  Eigen::Index directions = 0;
};

/// Computes the change d, its covariance and the p value of X^2 (symbols of predict()). `rows`:
/// information and score of the tested rows; `c`, `f`: covariance and factor of the fit.
Change change_of(const FitEvidence& rows, const Eigen::MatrixXd& c, double f) {
  constexpr double kShown = 1.0 / (kUnknown * kUnknown);
  const SymmetricEigen eigen = symmetric_eigen(rows.information);
  const Eigen::Index shown = (eigen.values.array() > kShown).count();
  if (shown == 0) return {};
  const Eigen::MatrixXd q = eigen.vectors.rightCols(shown);
  const Eigen::VectorXd inverse = eigen.values.tail(shown).cwiseInverse();
  const Eigen::VectorXd d = -inverse.cwiseProduct(q.transpose() * rows.score);
  Eigen::MatrixXd covariance = q.transpose() * c * q;
  covariance.diagonal() += f * f * inverse;
  const double squares = d.dot(solve_ldlt(covariance, d).col(0));
  return {q * d, q * covariance * q.transpose(),
          chi_squared_tail(squares, static_cast<double>(shown)), shown};
}

/// Cost of several parts of a log at common coordinates, with fitted initial states, and its
/// information and score.
struct PartCost {
  double cost = std::numeric_limits<double>::infinity();
  FitEvidence evidence;
};

PartCost cost_at(const std::vector<const LogProblem*>& parts,
                 const std::vector<double>& coordinates) {
  const Eigen::Index n = rows_of(coordinates);
  PartCost all{0.0, {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)}};
  for (const LogProblem* part : parts) {
    const std::vector<WindowSums> sums = sums_at(*part, with_initial_states(*part, coordinates));
    if (!all_finite(sums)) return {};
    for (const WindowSums& window : sums) all.cost += window.cost();
    const FitEvidence evidence = fit_evidence(sums, n);
    all.evidence.information += evidence.information;
    all.evidence.score += evidence.score;
  }
  return all;
}

/// Coordinates after one Gauss-Newton step, within their bounds. Directions that the rows hardly
/// determine do not change.
std::vector<double> stepped(const LogProblem& problem, const FitEvidence& evidence,
                            std::vector<double> coordinates) {
  constexpr double kNull = 1e-12;
  const SymmetricEigen eigen = symmetric_eigen(evidence.information);
  const double largest = eigen.values(eigen.values.size() - 1);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(eigen.values.size());
  for (Eigen::Index d = 0; d < eigen.values.size(); ++d) {
    if (!(eigen.values(d) > kNull * largest)) continue;
    const Eigen::VectorXd direction = eigen.vectors.col(d);
    step -= direction.dot(evidence.score) / eigen.values(d) * direction;
  }
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    coordinates[i] = std::clamp(coordinates[i] + step(eigen_index(i)), problem.bounds[i].lo,
                                problem.bounds[i].hi);
  }
  return coordinates;
}

/// Smallest cost of the parts near these coordinates: Gauss-Newton steps as long as they lower it.
double least_cost(const std::vector<const LogProblem*>& parts, std::vector<double> coordinates) {
  constexpr int kMostSteps = 4;
  constexpr double kSame = 0.01;
  PartCost best = cost_at(parts, coordinates);
  for (int k = 0; k < kMostSteps && std::isfinite(best.cost); ++k) {
    std::vector<double> next = stepped(*parts.front(), best.evidence, coordinates);
    PartCost at_next = cost_at(parts, next);
    if (!(at_next.cost < best.cost)) break;
    const double gain = best.cost - at_next.cost;
    best = std::move(at_next);
    coordinates = std::move(next);
    if (gain < kSame) break;
  }
  return best.cost;
}

}  // namespace

std::optional<HeldOut> predict(const LogPart& rows, const LogFit& fit, LogFitOptions options) {
  options.only_s = rows.only_s;
  const LogProblem problem = problem_of(rows.log, fit, options);
  const Places places = places_of(problem, fit.coordinates);
  if (problem.windows.empty() || places.compared.empty()) return std::nullopt;
  const std::vector<WindowSums> sums =
      sums_at(problem, with_initial_states(problem, fit.coordinates));
  if (!all_finite(sums)) return std::nullopt;
  Eigen::VectorXd scale(rows_of(fit.quantities));
  for (Eigen::Index i = 0; i < scale.size(); ++i) scale(i) = fit.quantities[at(i)].large_change;
  const Eigen::VectorXd unit = scale.cwiseInverse();
  const Eigen::MatrixXd c = unit.asDiagonal() * fit.covariance * unit.asDiagonal();
  const Change change = change_of(scaled_evidence(sums, scale, places),
                                  c(places.compared, places.compared), fit.widened);
  if (change.directions == 0) return std::nullopt;
  Eigen::Index most = 0;
  change.size.cwiseAbs().cwiseQuotient(change.covariance.diagonal().cwiseSqrt()).maxCoeff(&most);
  const std::size_t i = at(places.compared[at(most)]);
  const FreeQuantity& q = fit.quantities[i];
  const double x = fit.coordinates[i];
  return HeldOut{rows.name, change.p_value, q.name(), q.value(x),
                 q.value(x + q.large_change * change.size(most))};
}

std::optional<double> likelihood_ratio_test(const LogPart& fitted, const LogPart& rows,
                                            const LogFit& fit, const std::vector<double>& common,
                                            LogFitOptions options) {
  options.only_s = fitted.only_s;
  const LogProblem of_fit = problem_of(fitted.log, fit, options);
  options.only_s = rows.only_s;
  const LogProblem of_rows = problem_of(rows.log, fit, options);
  const LogFit by_rows = fit_logs(rows.log, options);
  if (!by_rows.usable || by_rows.coordinates.size() != common.size()) return std::nullopt;
  const double together = std::min(least_cost({&of_fit, &of_rows}, common),
                                   least_cost({&of_fit, &of_rows}, fit.coordinates));
  const double of_fit_alone =
      std::min(least_cost({&of_fit}, common), least_cost({&of_fit}, fit.coordinates));
  const double of_rows_alone =
      std::min(least_cost({&of_rows}, common), least_cost({&of_rows}, by_rows.coordinates));
  const double squares =
      2.0 * (together - of_fit_alone - of_rows_alone) / (fit.widened * fit.widened);
  if (!std::isfinite(squares)) return std::nullopt;
  const auto compared = static_cast<double>(places_of(of_fit, fit.coordinates).compared.size());
  return chi_squared_tail(std::max(0.0, squares), compared);
}

std::vector<TermTest> test_further_terms(const std::vector<DrivingLog>& log, const LogFit& fit,
                                         const LogFitOptions& options) {
  const LogProblem problem = problem_of(log, fit, options);
  if (problem.windows.empty()) return {};
  const std::vector<FreeQuantity> terms = further_terms(problem);
  const std::vector<ScoreTest> tests =
      score_test(problem, with_initial_states(problem, fit.coordinates), terms);
  std::vector<TermTest> found;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (tests[i].std_error > 0.0) found.push_back({terms[i], tests[i]});
  }
  return found;
}

}  // namespace awmr
