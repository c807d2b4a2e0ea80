#include "awmr/identify/tables/steady_fit.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/tables/robust.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// beta has to stay above 0 where the curve is inverted.
constexpr double kLeastInvertibleBeta = 1e-3;
constexpr double kAtBound = 1e-9;

/// g^-1(force) with its derivatives; 0 where the force does not overcome Coulomb friction. One
/// Newton step from the root in double carries the derivatives of an implicit function exactly.
template <class T>
T inverse(const Resistance<T>& law, const T& force) {
  const Resistance<double> plain{value_of(law.alpha), value_of(law.beta), 0.0,
                                 value_of(law.coulomb), value_of(law.quadratic)};
  const std::optional<double> root = steady_rate(plain, value_of(force));
  if (!root) return T(0.0);
  const double slope =
      plain.alpha * plain.beta * std::pow(*root, plain.beta - 1.0) + 2.0 * plain.quadratic * *root;
  return T(*root) - (law.at(T(*root)) - force) / slope;
}

/// The residual of one run over the five coordinates.
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
    if (!(rate > T(0.0))) return false;  // no motion takes forever: not a point to step to
    residual[0] = *point.travel / rate - *point.elapsed_s;
    return true;
  }
};

using Cost = ceres::AutoDiffCostFunction<SteadyResidual, 1, 1, 1, 1, 1, 1>;

Interval bounds_of(const SteadyProblem& problem, TransformedParameter c) {
  if (c == TransformedParameter::kLogAlpha) return {-kInfinity, kInfinity};
  if (c != TransformedParameter::kBeta) return {0.0, kInfinity};
  const bool inverted = problem.noise == ErrorModel::kSpeed || problem.noise == ErrorModel::kTime;
  const double lowest =
      inverted ? std::max(problem.beta_range.lo, kLeastInvertibleBeta) : problem.beta_range.lo;
  return {lowest, problem.beta_range.hi};
}

bool is_at(double bound, double value) {
  return std::isfinite(bound) && std::abs(value - bound) <= kAtBound;
}

/// The Ceres problem over five blocks of one number, those not free held constant.
class Search {
 public:
  Search(const SteadyProblem& problem, const TransformedParameters& start, std::optional<TransformedParameter> held)
      : problem_(problem), theta_(start) {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres_ = std::make_unique<ceres::Problem>(options);
    for (const SteadyPoint& point : problem.points) {
      ceres_->AddResidualBlock(new Cost(new SteadyResidual{point, problem.noise}), &loss_,
                               block(TransformedParameter::kLogAlpha), block(TransformedParameter::kBeta),
                               block(TransformedParameter::kCoulomb), block(TransformedParameter::kQuadratic),
                               block(TransformedParameter::kDeadZone));
    }
    const std::vector<TransformedParameter> family = coordinates_of(problem.family);
    for (std::size_t i = 0; i < kTransformedParameterCount; ++i) {
      const auto c = static_cast<TransformedParameter>(i);
      const bool in_family = std::find(family.begin(), family.end(), c) != family.end();
      if (!in_family || held == c) {
        ceres_->SetParameterBlockConstant(block(c));
        continue;
      }
      const Interval bounds = bounds_of(problem, c);
      theta_[i] = std::clamp(theta_[i], bounds.lo, bounds.hi);
      if (std::isfinite(bounds.lo)) ceres_->SetParameterLowerBound(block(c), 0, bounds.lo);
      if (std::isfinite(bounds.hi)) ceres_->SetParameterUpperBound(block(c), 0, bounds.hi);
    }
  }

  void solve() { ceres::Solve(exact_options(), ceres_.get(), &summary_); }

  /// The loss takes its scale from the residuals, which it changes: a few rounds settle both.
  void solve_robustly() {
    for (int round = 0; round < 20; ++round) {
      const double scale = median_scale(residuals());
      if (!(scale > 0.0)) return;  // over half of the points fit exactly: nothing to weigh down
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

  /// Without the loss.
  Eigen::VectorXd residuals() {
    std::vector<double> values;
    ceres::Problem::EvaluateOptions options;
    options.apply_loss_function = false;
    ceres_->Evaluate(options, nullptr, &values, nullptr, nullptr);
    return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  Eigen::MatrixXd jacobian(const std::vector<TransformedParameter>& columns) {
    ceres::Problem::EvaluateOptions options;
    options.apply_loss_function = false;
    for (const TransformedParameter c : columns) options.parameter_blocks.push_back(block(c));
    ceres::CRSMatrix rows;
    ceres_->Evaluate(options, nullptr, nullptr, nullptr, &rows);
    return dense(rows);
  }

  const TransformedParameters& theta() const { return theta_; }
  const ceres::Solver::Summary& summary() const { return summary_; }
  const ceres::LossFunction& loss() const { return loss_; }

 private:
  double* block(TransformedParameter c) { return &theta_[static_cast<std::size_t>(c)]; }

  const SteadyProblem& problem_;
  TransformedParameters theta_;
  ceres::LossFunctionWrapper loss_{nullptr, ceres::TAKE_OWNERSHIP};
  std::unique_ptr<ceres::Problem> ceres_;
  ceres::Solver::Summary summary_;
};

/// Residuals and Jacobian at the solution -> rank, condition, leverages, covariance.
void add_uncertainty(const SteadyProblem& problem, Search& search, SteadyFit& fit) {
  const auto n = static_cast<Eigen::Index>(problem.points.size());
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

/// Without another fit: the power law by QR, then a share of the least force for each new term.
TransformedParameters first_guess(const SteadyProblem& problem) {
  const SteadyFit line = fit_log_linear(problem.points);
  TransformedParameters start{line[TransformedParameter::kLogAlpha], 1.0, 0.0, 0.0, 0.0};
  const FamilyTerms terms = terms_of(problem.family);
  if (terms.beta) start[static_cast<std::size_t>(TransformedParameter::kBeta)] = line[TransformedParameter::kBeta];
  double least = kInfinity;
  for (const SteadyPoint& point : problem.points) least = std::min(least, point.force);
  if (terms.coulomb) start[static_cast<std::size_t>(TransformedParameter::kCoulomb)] = 0.5 * least;
  if (terms.dead_zone) start[static_cast<std::size_t>(TransformedParameter::kDeadZone)] = 0.5 * least;
  if (terms.quadratic) start[static_cast<std::size_t>(TransformedParameter::kQuadratic)] = 0.0;
  return start;
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
  return fit_steady(problem, first_guess(problem));
}

SteadyFit fit_steady(const SteadyProblem& problem, const TransformedParameters& start) {
  Search search(problem, start, std::nullopt);
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

SteadyRows steady_rows(const SteadyProblem& problem, const TransformedParameters& at,
                       const std::vector<TransformedParameter>& by) {
  Search search(problem, at, std::nullopt);
  return {search.residuals(), search.jacobian(by)};
}

double profile_cost(const SteadyProblem& problem, const TransformedParameters& start, TransformedParameter held,
                    double value) {
  TransformedParameters from = start;
  from[static_cast<std::size_t>(held)] = value;
  Search search(problem, from, held);
  search.solve();
  if (!search.summary().IsSolutionUsable()) return kInfinity;
  return search.residuals().squaredNorm();
}

Interval profile_interval(const SteadyProblem& problem, const SteadyFit& fit, TransformedParameter c) {
  const double s = fit.residual_std;
  const double t = t_quantile_95(fit.degrees_of_freedom);
  const double least = fit.residuals.squaredNorm();
  const double std_error = *fit.std_error(c);
  const Interval bounds = bounds_of(problem, c);
  // zeta(x) = sqrt(profile(x) - least)/s is |x - x0|/std_error where the model is linear: a secant
  // on it needs few steps.
  const auto zeta = [&](double x) {
    return std::sqrt(std::max(0.0, profile_cost(problem, fit.theta, c, x) - least)) / s;
  };
  const auto end = [&](double sign) {
    const double bound = sign > 0.0 ? bounds.hi : bounds.lo;
    const auto inside = [&](double x) {
      return sign > 0.0 ? std::min(x, bound) : std::max(x, bound);
    };
    double near = fit[c];
    double near_zeta = 0.0;
    double far = inside(fit[c] + sign * t * std_error);
    double far_zeta = zeta(far);
    for (int i = 0; i < 40 && far_zeta < t; ++i) {
      if (far == bound) return bound;
      near = far;
      near_zeta = far_zeta;
      far = inside(far + sign * t * std_error * std::pow(1.5, i));
      far_zeta = zeta(far);
    }
    for (int i = 0; i < 60 && std::abs(far - near) > 1e-9 * std_error; ++i) {
      // Regula falsi kept away from the ends, so that the bracket always shrinks.
      const double share = std::isfinite(far_zeta) ? (t - near_zeta) / (far_zeta - near_zeta) : 0.5;
      const double x = near + std::clamp(share, 0.02, 0.98) * (far - near);
      const double at = zeta(x);
      if (std::abs(at - t) < 1e-8) return x;
      (at < t ? near : far) = x;
      (at < t ? near_zeta : far_zeta) = at;
    }
    return 0.5 * (near + far);
  };
  return {end(-1.0), end(1.0)};
}

std::optional<double> aicc(const SteadyFit& fit) {
  const auto n = static_cast<double>(fit.residuals.size());
  const double k = static_cast<double>(fit.free.size() + fit.at_bound.size()) + 1.0;
  if (n <= k + 1.0) return std::nullopt;
  const double sse = fit.residuals.squaredNorm();
  if (!(sse > 0.0)) return std::nullopt;
  return n * std::log(sse / n) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
}

}  // namespace awmr
