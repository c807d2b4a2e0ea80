#include "awmr/identify/tables/steady_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/tables/robust.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

/// Lower bound of beta if the speed or the time has the error. The residuals then need the inverse
/// of the curve, which does not exist for beta = 0.
constexpr double kMinimumInvertibleBeta = 1e-3;

/// Returns the steady rate w at a force, the root of g(w) = force. 0 if the force is below Coulomb
/// friction. Finds the root in double precision. One Newton step from the root in the type T (a
/// ceres::Jet) then adds the derivatives of w with respect to the coordinates of the law.
template <class T>
T inverse(const Resistance<T>& law, const T& force) {
  const Resistance<double> plain = value_of(law);
  const std::optional<double> root = steady_rate(plain, value_of(force));
  if (!root) return T(0.0);
  const double jacobian =
      plain.alpha * plain.beta * std::pow(*root, plain.beta - 1.0) + 2.0 * plain.quadratic * *root;
  return T(*root) - (law.at(T(*root)) - force) / jacobian;
}

/// The residual of one run as a function of the five coordinates.
struct SteadyResidual {
  SteadyPoint point;
  ErrorModel noise;

  template <class T>
  bool operator()(const T* log_alpha, const T* beta, const T* coulomb, const T* quadratic,
                  const T* dead_zone, T* residual) const {
    using std::exp;
    const Resistance<T> law{exp(*log_alpha), *beta, T(0.0), *coulomb, *quadratic};
    const T force = T(point.force) - *dead_zone;
    if (noise == ErrorModel::kForce) {
      residual[0] = law.at(T(point.rate)) - force;
      return true;
    }
    if (noise == ErrorModel::kLogForce) {
      using std::log;
      if (!(force > T(0.0))) return false;
      residual[0] = log(law.at(T(point.rate)) / force);
      return true;
    }
    const T rate = inverse(law, force);
    if (noise == ErrorModel::kSpeed) {
      residual[0] = rate - point.rate;
      return true;
    }
    if (!(rate > T(0.0))) return false;  // no motion has infinite time: Ceres rejects the point
    residual[0] = *point.travel / rate - *point.elapsed_s;
    return true;
  }
};

using SteadyCost = ceres::AutoDiffCostFunction<SteadyResidual, 1, 1, 1, 1, 1, 1>;

/// Ends a search when the same coordinates have been at their bounds for kIterations iterations.
class StopAtBound : public ceres::IterationCallback {
 public:
  explicit StopAtBound(std::function<std::vector<TransformedParameter>()> at_bound)
      : at_bound_(std::move(at_bound)) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    std::vector<TransformedParameter> now = at_bound_();
    iterations_ = !now.empty() && now == held_ ? iterations_ + 1 : 0;
    held_ = std::move(now);
    return iterations_ < kIterations ? ceres::SOLVER_CONTINUE
                                     : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }
  /// Coordinates that were at a bound when this callback ended the search; empty if the search
  /// ended for another reason.
  std::vector<TransformedParameter> held() const {
    return iterations_ < kIterations ? std::vector<TransformedParameter>() : held_;
  }

 private:
  static constexpr int kIterations = 3;
  std::function<std::vector<TransformedParameter>()> at_bound_;
  std::vector<TransformedParameter> held_;
  int iterations_ = 0;
};

}  // namespace

Interval bounds_of(const SteadyProblem& problem, TransformedParameter c) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (c == TransformedParameter::kLogAlpha) return {-kInfinity, kInfinity};
  if (c != TransformedParameter::kBeta) return {0.0, kInfinity};
  const bool inverted = problem.noise == ErrorModel::kSpeed || problem.noise == ErrorModel::kTime;
  const double lowest =
      inverted ? std::max(problem.beta_range.lo, kMinimumInvertibleBeta) : problem.beta_range.lo;
  return {lowest, problem.beta_range.hi};
}

SteadySearch::SteadySearch(const SteadyProblem& problem, const TransformedParameters& initial_guess,
                           std::optional<TransformedParameter> held)
    : problem_(problem), theta_(initial_guess) {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres_ = std::make_unique<ceres::Problem>(options);
  for (const SteadyPoint& point : problem.points) {
    ceres_->AddResidualBlock(
        new SteadyCost(new SteadyResidual{point, problem.noise}), &loss_,
        block(TransformedParameter::kLogAlpha), block(TransformedParameter::kBeta),
        block(TransformedParameter::kCoulomb), block(TransformedParameter::kQuadratic),
        block(TransformedParameter::kDeadZone));
  }
  free_or_hold(held);
}

void SteadySearch::free_or_hold(std::optional<TransformedParameter> held) {
  const std::vector<TransformedParameter> family = coordinates_of(problem_.family);
  for (std::size_t i = 0; i < kTransformedParameterCount; ++i) {
    const auto c = static_cast<TransformedParameter>(i);
    const bool in_family = std::find(family.begin(), family.end(), c) != family.end();
    if (!in_family || held == c) {
      ceres_->SetParameterBlockConstant(block(c));
      continue;
    }
    const Interval bounds = bounds_of(problem_, c);
    free_.push_back(c);
    theta_[i] = std::clamp(theta_[i], bounds.lo, bounds.hi);
    if (std::isfinite(bounds.lo)) ceres_->SetParameterLowerBound(block(c), 0, bounds.lo);
    if (std::isfinite(bounds.hi)) ceres_->SetParameterUpperBound(block(c), 0, bounds.hi);
  }
}

bool SteadySearch::is_at_bound(TransformedParameter c) const {
  const Interval bounds = bounds_of(problem_, c);
  return theta_[at(c)] <= bounds.lo || theta_[at(c)] >= bounds.hi;
}

/// Searches until convergence, or until coordinates stay at a bound. Returns the coordinates that
/// stayed at a bound; empty after convergence.
std::vector<TransformedParameter> SteadySearch::search_until_at_bound() {
  StopAtBound stop([this] {
    std::vector<TransformedParameter> at_bound;
    std::copy_if(free_.begin(), free_.end(), std::back_inserter(at_bound),
                 [this](TransformedParameter c) { return is_at_bound(c); });
    return at_bound;
  });
  ceres::Solver::Options options = exact_options();
  options.update_state_every_iteration = true;
  options.callbacks.push_back(&stop);
  ceres::Solve(options, ceres_.get(), &summary_);
  return stop.held();
}

/// True if the cost decreases when the coordinate `c` moves away from the bound that it is at.
bool SteadySearch::falls_inwards(TransformedParameter c) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = {block(c)};
  std::vector<double> gradient;
  if (!ceres_->Evaluate(options, nullptr, nullptr, &gradient, nullptr)) return true;
  return theta_[at(c)] <= bounds_of(problem_, c).lo ? gradient[0] < 0.0 : gradient[0] > 0.0;
}

void SteadySearch::solve() {
  const std::vector<TransformedParameter> held = search_until_at_bound();
  if (held.empty()) return;
  for (const TransformedParameter c : held) ceres_->SetParameterBlockConstant(block(c));
  ceres::Solve(exact_options(), ceres_.get(), &summary_);
  const bool wrong = std::any_of(held.begin(), held.end(),
                                 [this](TransformedParameter c) { return falls_inwards(c); });
  for (const TransformedParameter c : held) ceres_->SetParameterBlockVariable(block(c));
  if (wrong) ceres::Solve(exact_options(), ceres_.get(), &summary_);
}

void SteadySearch::solve_robustly() {
  for (int round = 0; round < 20; ++round) {
    const std::optional<Eigen::VectorXd> e = residuals();
    if (!e) return;  // the search failed; the summary has the reason
    const double scale = median_scale(*e);
    // If more than half of the points fit exactly, the scale is 0, and the robust loss is not
    // defined.
    if (!(scale > 0.0)) return;
    loss_.Reset(make_loss(problem_.loss, scale).release(), ceres::TAKE_OWNERSHIP);
    const TransformedParameters before = theta_;
    solve();
    double moved = 0.0;
    for (std::size_t i = 0; i < kTransformedParameterCount; ++i) {
      moved = std::max(moved, std::abs(theta_[i] - before[i]));
    }
    if (moved < 1e-10) return;
  }
}

std::optional<Eigen::VectorXd> SteadySearch::residuals() {
  ceres::Problem::EvaluateOptions options;
  options.apply_loss_function = false;
  return evaluated_residuals(*ceres_, options);
}

std::optional<Eigen::MatrixXd> SteadySearch::jacobian(
    const std::vector<TransformedParameter>& columns) {
  ceres::Problem::EvaluateOptions options;
  options.apply_loss_function = false;
  for (const TransformedParameter c : columns) options.parameter_blocks.push_back(block(c));
  return evaluated_jacobian(*ceres_, options);
}

}  // namespace awmr
