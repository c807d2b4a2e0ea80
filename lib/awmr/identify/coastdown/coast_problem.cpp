#include "awmr/identify/coastdown/coast_problem.h"

#include <algorithm>
#include <cmath>

#include "awmr/identify/ceres_solve.h"

namespace awmr {
namespace {

/// Speed u after the time tau_s from u0 under a power law, in closed form with k = a/m':
///   u = u0 (1 - s z)^(1/s),  s = 1 - b,  z = k tau u0^-s;  0 once s z >= 1;  u0 e^-z for s -> 0
template <class T>
T coasted(const T& u0, const T& beta, const T& k, const T& tau_s) {
  using std::exp;
  using std::log;
  using std::pow;
  if (!(u0 > T(0.0))) return u0;
  const T s = 1.0 - beta;
  const T z = k * tau_s * pow(u0, -s);
  const T x = s * z;
  if (!(x < T(1.0))) return T(0.0);
  constexpr double kSmall = 1e-4;
  // ln(1 - x)/s = -z (1 + x/2 + x^2/3 + x^3/4 + ...), x = s z; omitted terms are below 1e-17
  if (x < T(kSmall) && x > T(-kSmall)) {
    return u0 * exp(-z * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0)))));
  }
  return u0 * exp(log(1.0 - x) / s);
}

/// One classical Runge-Kutta step of m' u_dot = -g(u). A vehicle at rest stays at rest.
template <class T>
T coast_step(const Resistance<T>& law, const T& mass, const T& u, const T& h) {
  if (!(u > T(0.0))) return T(0.0);
  const auto rate = [&](const T& at) { return at > T(0.0) ? T(-law.at(at) / mass) : T(0.0); };
  const T k1 = rate(u);
  const T k2 = rate(T(u + 0.5 * h * k1));
  const T k3 = rate(T(u + 0.5 * h * k2));
  const T k4 = rate(T(u + h * k3));
  const T next = u + h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
  return next > T(0.0) ? next : T(0.0);
}

/// Largest number of steps between two samples: half an hour in steps of 2 ms. A point of the
/// search that needs more steps, because its t0 diverges, is rejected.
constexpr double kMaximumSteps = 1e6;

/// Residuals of one curve as a function of ln a, b, c, q, ln m' and (u0, t0).
struct CoastResidual {
  const CoastCurve* curve;
  double longest_step_s;

  template <class T>
  bool operator()(const T* log_alpha, const T* beta, const T* coulomb, const T* quadratic,
                  const T* log_mass, const T* initial, T* residual) const {
    using std::exp;
    const bool closed =
        value_of(*coulomb) == 0.0 && value_of(*quadratic) == 0.0 && !derivative_wanted;
    const T k = exp(*log_alpha - *log_mass);
    const Resistance<T> law{exp(*log_alpha), *beta, T(0.0), *coulomb, *quadratic};
    const T mass = exp(*log_mass);
    T u = initial[0];
    T at_s = initial[1];
    for (std::size_t i = 0; i < curve->t_s.size(); ++i) {
      const double t_s = curve->t_s[i];
      if (T(t_s) > initial[1]) {
        if (closed) {
          u = coasted(initial[0], *beta, k, T(T(t_s) - initial[1]));
        } else {
          const double count = (t_s - value_of(at_s)) / longest_step_s;
          if (!(count < kMaximumSteps)) return false;  // Ceres rejects this point
          const int steps = 1 + static_cast<int>(count);
          const T h = (T(t_s) - at_s) / static_cast<double>(steps);
          for (int n = 0; n < steps; ++n) u = coast_step(law, mass, u, h);
          at_s = T(t_s);
        }
      }
      residual[i] = u - curve->speed_mps[i];
    }
    return true;
  }

  /// True: derivatives by c or q are needed, which the closed form does not have.
  bool derivative_wanted = false;
};

using CoastCost = ceres::AutoDiffCostFunction<CoastResidual, ceres::DYNAMIC, 1, 1, 1, 1, 1, 2>;

/// Longest step h of the Runge-Kutta method. Its error over one time constant T of the motion is
/// (h/T)^4/120 of the speed: 2e-8 for T = 0.05 s.
constexpr double kLongestStep_s = 2e-3;

/// Finds the plateau of the speed before motors-off. It ends at the last sample within 4 standard
/// deviations of the mean of the samples before it; a plateau needs more than eight samples. The
/// standard deviation of the noise is the root mean square of the second differences over sqrt(6),
/// because second differences of a smooth curve are small.
CoastInitialState initial_state_of(const CoastCurve& curve) {
  const std::vector<double>& u = curve.speed_mps;
  double squares = 0.0;
  for (std::size_t i = 2; i < u.size(); ++i) {
    const double second = u[i] - 2.0 * u[i - 1] + u[i - 2];
    squares += second * second;
  }
  const double noise = std::sqrt(squares / (6.0 * static_cast<double>(u.size() - 2)));
  double level = u[0];
  std::size_t end = 0;
  for (std::size_t i = 1; i < u.size(); ++i) {
    if (std::abs(u[i] - level) <= 4.0 * noise) {
      level += (u[i] - level) / static_cast<double>(i + 1);
      end = i;
    } else if (i > end + 3) {
      break;
    }
  }
  constexpr std::size_t kShortestPlateau = 8;
  const bool plateau = end >= kShortestPlateau && end + kShortestPlateau < u.size();
  if (!plateau) return {{u[0], curve.t_s[0]}, false};
  return {{level, curve.t_s[end]}, true};
}

}  // namespace

CoastProblem::CoastProblem(const std::vector<CoastCurve>& curves,
                           const TransformedParameters& surge, double log_mass, bool terms_free)
    : curves_(&curves), theta_(surge), log_mass_(log_mass) {
  initial_.reserve(curves.size());
  for (const CoastCurve& curve : curves) {
    initial_.push_back(initial_state_of(curve));
    auto* cost = new CoastCost(
        new CoastResidual{
            .curve = &curve, .longest_step_s = kLongestStep_s, .derivative_wanted = terms_free},
        static_cast<int>(curve.t_s.size()));
    double* initial = initial_.back().block;
    problem_.AddResidualBlock(cost, nullptr, &theta_[0], &theta_[1], &theta_[2], &theta_[3],
                              &log_mass_, initial);
    if (!initial_.back().free_time) {
      problem_.SetManifold(initial, new ceres::SubsetManifold(2, {1}));
    }
    sizes_.push_back(static_cast<int>(curve.t_s.size()));
  }
  for (std::size_t i = 0; i < 4; ++i) problem_.SetParameterBlockConstant(&theta_[i]);
}

void CoastProblem::solve() {
  ceres::Solve(exact_options(), &problem_, &summary_);
  // A run whose fitted motors-off time is before its first sample has no plateau. Its t0 is fixed
  // at the first sample, because it cannot be separated from u0.
  bool again = false;
  for (std::size_t i = 0; i < initial_.size(); ++i) {
    CoastInitialState& initial = initial_[i];
    const double first_s = (*curves_)[i].t_s.front();
    if (!initial.free_time || initial.block[1] > first_s) continue;
    initial = {{(*curves_)[i].speed_mps.front(), first_s}, false};
    problem_.SetManifold(initial.block, new ceres::SubsetManifold(2, {1}));
    again = true;
  }
  if (again) ceres::Solve(exact_options(), &problem_, &summary_);
}

std::optional<Eigen::VectorXd> CoastProblem::residuals() {
  return evaluated_residuals(problem_, {});
}

std::optional<Eigen::MatrixXd> CoastProblem::jacobian(const std::vector<double*>& first) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = first;
  for (CoastInitialState& initial : initial_) options.parameter_blocks.push_back(initial.block);
  for (double* block : first) problem_.SetParameterBlockVariable(block);
  return evaluated_jacobian(problem_, options);
}

void CoastProblem::step(const std::vector<TransformedParameter>& free, const Eigen::VectorXd& by) {
  Eigen::Index next = 0;
  for (const TransformedParameter c : free) *block(c) += by(next++);
  log_mass_ += by(next++);
  for (CoastInitialState& initial : initial_) {
    initial.block[0] += by(next++);
    if (initial.free_time) initial.block[1] += by(next++);
  }
}

double guess_log_mass(const std::vector<CoastCurve>& curves, const Resistance<double>& law) {
  for (const CoastCurve& curve : curves) {
    const double top = *std::max_element(curve.speed_mps.begin(), curve.speed_mps.end());
    double high_s = curve.t_s.front();
    double low_s = curve.t_s.back();
    for (std::size_t i = 0; i < curve.t_s.size(); ++i) {
      if (curve.speed_mps[i] > 0.9 * top) high_s = curve.t_s[i];
    }
    for (std::size_t i = curve.t_s.size(); i-- > 0;) {
      if (curve.speed_mps[i] < 0.5 * top && curve.t_s[i] > high_s) low_s = curve.t_s[i];
    }
    if (top > 0.0 && low_s > high_s)
      return std::log(law.at(0.7 * top) * (low_s - high_s) / (0.4 * top));
  }
  return std::log(0.1);
}

}  // namespace awmr
