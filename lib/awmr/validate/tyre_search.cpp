// Least-squares search for the tyre parameters that minimise the cost of tyre_fit.h.
#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/interval.h"
#include "awmr/core/statistics/silent_ceres.h"
#include "awmr/model/ranges.h"
#include "awmr/validate/tyre_windows.h"

namespace awmr::tyre_fit {
namespace {

/// The windows do not determine a parameter if the standard error of its logarithm exceeds this.
constexpr double kLargestLogError = 0.5;

Interval range_of(Eigen::Index parameter) {
  const NumberRule& rule =
      parameter == kFriction ? kTyreFrictionRule : kCorneringStiffnessRule_per_rad;
  return {std::log(rule.min), std::log(rule.max)};
}

Eigen::VectorXd weighted(const ReplayedWindow& window, const Weights& weights,
                         Eigen::VectorXd errors) {
  for (Eigen::Index i = 0; i < errors.size(); ++i) errors[i] *= weights[at(window.channels[at(i)])];
  return errors;
}

/// Step of the forward differences, in the logarithm of a parameter. Smaller steps would give wrong
/// derivatives, because the errors jump where the simulation changes its integration step.
constexpr double kStepOfDerivative = 1e-3;

class TyreCost : public ceres::CostFunction {
 public:
  TyreCost(const ReplayedWindow& window, const Plants& plants, const Weights& weights)
      : window_(window), plants_(plants), weights_(weights) {
    set_num_residuals(static_cast<int>(window.channels.size()));
    *mutable_parameter_block_sizes() = {1, 1};
  }
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const LogTyres tyres{*parameters[kFriction], *parameters[kCornering]};
    const Eigen::Index count = num_residuals();
    const auto errors = errors_on_tyres(window_, plants_, tyres);
    if (!errors) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, count) = weighted(window_, weights_, *errors);
    for (Eigen::Index p = 0; jacobians != nullptr && p < 2; ++p) {
      if (jacobians[p] == nullptr) continue;
      const LogTyres step = kStepOfDerivative * LogTyres::Unit(p);
      const auto above = errors_on_tyres(window_, plants_, tyres + step);
      if (!above) return false;
      Eigen::Map<Eigen::VectorXd>(jacobians[p], count) =
          weighted(window_, weights_, (*above - *errors) / kStepOfDerivative);
    }
    return true;
  }

 private:
  const ReplayedWindow& window_;
  const Plants& plants_;
  const Weights& weights_;
};

ceres::Problem problem_of(const Windows& windows, const Plants& plants, const Weights& weights,
                          const IsFree& is_free, LogTyres& at) {
  ceres::Problem problem;
  for (const ReplayedWindow* window : windows) {
    problem.AddResidualBlock(new TyreCost(*window, plants, weights), nullptr, &at[kFriction],
                             &at[kCornering]);
  }
  for (const Eigen::Index p : {kFriction, kCornering}) {
    problem.SetParameterLowerBound(&at[p], 0, range_of(p).lo);
    problem.SetParameterUpperBound(&at[p], 0, range_of(p).hi);
    if (!is_free[awmr::at(p)]) problem.SetParameterBlockConstant(&at[p]);
  }
  return problem;
}

/// Returns the three best points of a coarse grid as starts of the search, best first. The search
/// needs several starts because the cost can have several minima: a sliding vehicle can spin to
/// either side. To save time, only every third window is evaluated.
std::vector<LogTyres> starts_of(const Windows& windows, const Plants& plants) {
  constexpr std::array kFrictions{0.25, 0.5, 0.75, 1.1};
  constexpr std::array kStiffnesses{3.0, 6.0, 12.0, 24.0};
  constexpr std::size_t kMaxStarts = 3;
  Windows some;
  for (std::size_t i = 0; i < windows.size(); i += 3) some.push_back(windows[i]);
  std::vector<std::pair<double, LogTyres>> points;
  for (const double friction : kFrictions) {
    for (const double stiffness : kStiffnesses) {
      const LogTyres at{std::log(friction), std::log(stiffness)};
      if (const auto sums = sums_on_tyres(some, plants, at)) points.emplace_back(sums->cost(), at);
    }
  }
  std::ranges::sort(points, {}, [](const auto& point) { return point.first; });
  std::vector<LogTyres> starts;
  for (std::size_t i = 0; i < std::min(points.size(), kMaxStarts); ++i) {
    starts.push_back(points[i].second);
  }
  return starts;
}

/// Contribution of one window to the normal equations at the fit: J'J and J'e. e: weighted errors
/// of the window; J: their Jacobian by the tyre parameters, 0 for parameters that are not fitted.
struct WindowInformation {
  Eigen::Matrix2d information;
  Eigen::Vector2d score;
};

std::optional<WindowInformation> information_of(const ReplayedWindow& window, const Plants& plants,
                                                const IsFree& is_free, const Fit& fit) {
  const TyreCost cost(window, plants, fit.weights);
  const auto count = rows_of(window.channels);
  Eigen::VectorXd errors(count);
  Eigen::MatrixXd by(count, 2);
  const double* at[] = {&fit.at[kFriction], &fit.at[kCornering]};
  double* columns[] = {by.col(kFriction).data(), by.col(kCornering).data()};
  if (!cost.Evaluate(at, errors.data(), columns)) return std::nullopt;
  for (const Eigen::Index p : {kFriction, kCornering}) {
    if (!is_free[awmr::at(p)]) by.col(p).setZero();
  }
  return WindowInformation{by.transpose() * by, by.transpose() * errors};
}

/// Standard errors of the logarithms of the tyre parameters, by the jackknife over windows
/// (tyre_fit.h). Empty for parameters that are not fitted. Both are empty if a parameter depends on
/// a single window, or if a window cannot be simulated.
std::array<std::optional<double>, 2> log_errors(const Windows& windows, const Plants& plants,
                                                const IsFree& is_free, const Fit& fit) {
  std::vector<WindowInformation> each;
  Eigen::Matrix2d held = Eigen::Matrix2d::Zero();
  for (const Eigen::Index p : {kFriction, kCornering}) {
    if (!is_free[at(p)]) held(p, p) = 1.0;
  }
  Eigen::Matrix2d information = held;
  for (const ReplayedWindow* window : windows) {
    const auto one = information_of(*window, plants, is_free, fit);
    if (!one) return {};
    information += one->information;
    each.push_back(*one);
  }
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();
  for (const WindowInformation& one : each) {
    const Eigen::LLT<Eigen::Matrix2d> without(information - one.information);
    if (without.info() != Eigen::Success) return {};
    variance += without.solve(one.score).cwiseAbs2();
  }
  const auto count = static_cast<double>(windows.size());
  variance *= (count - 1.0) / count;
  std::array<std::optional<double>, 2> of;
  for (const Eigen::Index p : {kFriction, kCornering}) {
    const bool is_known = is_free[at(p)] && variance[p] > 0.0 && std::isfinite(variance[p]);
    if (is_known) of[at(p)] = std::sqrt(variance[p]);
  }
  return of;
}

bool is_inside(Eigen::Index parameter, double log_value) {
  // A parameter this near to an end of its range counts as being at the end (in the logarithm).
  constexpr double kNear = 1e-3;
  const Interval range = range_of(parameter);
  return log_value > range.lo + kNear && log_value < range.hi - kNear;
}

/// Returns the free parameter with the largest standard error among those that the windows do not
/// determine. Empty if they determine all free parameters.
std::optional<Eigen::Index> least_shown(const ShownFit& shown) {
  std::optional<Eigen::Index> worst;
  double largest = 0.0;
  for (const Eigen::Index p : {kFriction, kCornering}) {
    if (!shown.is_free[at(p)]) continue;
    const double error = shown.errors[at(p)].value_or(std::numeric_limits<double>::infinity());
    const bool is_shown = error <= kLargestLogError && is_inside(p, shown.fit.at[p]);
    if (is_shown || error <= largest) continue;
    worst = p;
    largest = error;
  }
  return worst;
}

/// The fit with the smallest cost. Empty if the windows cannot be simulated from any start.
std::optional<Fit> best_fit(const Windows& windows, const Plants& plants, const IsFree& is_free,
                            const std::vector<LogTyres>& starts) {
  std::optional<Fit> best;
  for (const LogTyres& start : starts) {
    auto found = fit(windows, plants, is_free, start);
    if (found && (!best || found->cost < best->cost)) best = std::move(found);
  }
  return best;
}

}  // namespace

LogTyres default_tyres() {
  return {std::log(kTyreFriction), std::log(kCorneringStiffness_per_rad)};
}

std::optional<Fit> fit(const Windows& windows, const Plants& plants, const IsFree& is_free,
                       const LogTyres& from) {
  constexpr int kMaxRounds = 8;
  // The fit has converged if the last step changes the cost per error by less than this.
  constexpr double kSameCost = 1e-5;
  const auto first = sums_on_tyres(windows, plants, from);
  if (!first) return std::nullopt;
  Fit best{.at = from, .weights = first->weights(), .cost = first->cost()};
  for (int round = 0; round < kMaxRounds && !best.converged; ++round) {
    Fit next = best;
    ceres::Problem problem = problem_of(windows, plants, best.weights, is_free, next.at);
    silence_ceres();
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 30;
    options.function_tolerance = 1e-5;
    options.parameter_tolerance = 1e-5;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    next.stop_reason = summary.message;
    const auto sums = sums_on_tyres(windows, plants, next.at);
    if (!summary.IsSolutionUsable() || !sums) return next;
    next.cost = sums->cost();
    next.weights = sums->weights();
    next.converged = summary.termination_type == ceres::CONVERGENCE &&
                     std::abs(best.cost - next.cost) <= kSameCost * problem.NumResiduals();
    best = std::move(next);
  }
  return best;
}

std::optional<ShownFit> fit_what_is_shown(const Windows& windows, const Plants& plants) {
  std::vector<LogTyres> starts = starts_of(windows, plants);
  ShownFit shown;
  while (shown.is_free[kFriction] || shown.is_free[kCornering]) {
    const auto found = best_fit(windows, plants, shown.is_free, starts);
    if (!found) return std::nullopt;
    shown.fit = *found;
    if (!found->converged) return shown;
    shown.errors = log_errors(windows, plants, shown.is_free, *found);
    const auto worst = least_shown(shown);
    if (!worst) return shown;
    shown.is_free[at(*worst)] = false;
    starts = {found->at};
    starts.front()[*worst] = default_tyres()[*worst];
  }
  return shown;
}

}  // namespace awmr::tyre_fit
