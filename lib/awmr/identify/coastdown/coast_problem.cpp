#include "awmr/identify/coastdown/coast_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/ceres_solve.h"

namespace awmr {
namespace {

/// Speed u of a coasting vehicle with the resistance a u^b, at the time tau_s after it had the
/// speed u0. Closed form with k = a/m':
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

/// Largest number of integration steps between two samples: half an hour in steps of 2 ms. A search
/// needs more only if its t0, the time of switching the motors off, diverges; Ceres then rejects
/// the point.
constexpr double kMaximumSteps = 1e6;

/// Output of the filter T y' = u - y after the time h, if its output was y and its input changes
/// linearly from u to `next`. `lag_s`: time constant T.
template <class T>
T filtered(const T& y, const T& u, const T& next, const T& h, const T& lag_s) {
  using std::exp;
  const T behind = (next - u) * (lag_s / h);
  return next - behind + (y - u + behind) * exp(-h / lag_s);
}

/// Residuals of one curve: modelled minus measured speeds. Parameters: see CoastProblem.
struct CoastResidual {
  const CoastCurve* curve;
  /// Longest integration step before each sample, s.
  std::vector<double> longest_step_s;
  /// True: derivatives with respect to c or q are needed, so the closed form is not used.
  bool derivative_wanted = false;
  bool has_filter = false;

  template <class T>
  bool operator()(const T* log_alpha, const T* beta, const T* coulomb, const T* quadratic,
                  const T* log_mass, const T* lag_s, const T* initial, T* residual) const {
    using std::exp;
    const bool closed = value_of(*coulomb) == 0.0 && value_of(*quadratic) == 0.0 &&
                        !derivative_wanted && !has_filter;
    const T k = exp(*log_alpha - *log_mass);
    const Resistance<T> law{exp(*log_alpha), *beta, T(0.0), *coulomb, *quadratic};
    const T mass = exp(*log_mass);
    T u = initial[0];
    T y = u;
    T at_s = initial[1];
    for (std::size_t i = 0; i < curve->t_s.size(); ++i) {
      const double t_s = curve->t_s[i];
      if (T(t_s) > initial[1]) {
        if (closed) {
          y = coasted(initial[0], *beta, k, T(T(t_s) - initial[1]));
        } else {
          const double count = (t_s - value_of(at_s)) / longest_step_s[i];
          if (!(count < kMaximumSteps)) return false;  // Ceres rejects this point
          const int steps = 1 + static_cast<int>(count);
          const T h = (T(t_s) - at_s) / static_cast<double>(steps);
          for (int n = 0; n < steps; ++n) {
            const T next = coast_step(law, mass, u, h);
            y = has_filter ? filtered(y, u, next, h, *lag_s) : next;
            u = next;
          }
          at_s = T(t_s);
        }
      }
      residual[i] = y - curve->speed_mps[i];
    }
    return true;
  }
};

using CoastCost = ceres::AutoDiffCostFunction<CoastResidual, ceres::DYNAMIC, 1, 1, 1, 1, 1, 1, 2>;

/// Prior that keeps the surge law near the law `given`. Its residuals are root (theta - given), for
/// the coordinates theta in `free`. root^T root is the inverse covariance of the prior times the
/// noise variance of the curves.
struct LawPrior {
  Eigen::MatrixXd root;
  std::vector<TransformedParameter> free;
  TransformedParameters given;

  template <class T>
  bool operator()(const T* log_alpha, const T* beta, const T* coulomb, const T* quadratic,
                  T* residual) const {
    const T* theta[] = {log_alpha, beta, coulomb, quadratic};
    for (Eigen::Index i = 0; i < root.rows(); ++i) {
      residual[i] = T(0.0);
      for (Eigen::Index j = 0; j < root.cols(); ++j) {
        const std::size_t c = at(free[at(j)]);
        residual[i] += root(i, j) * (*theta[c] - given[c]);
      }
    }
    return true;
  }
};

using LawCost = ceres::AutoDiffCostFunction<LawPrior, ceres::DYNAMIC, 1, 1, 1, 1>;

/// Time constant m' u/g(u) of the deceleration at the speed u, s.
double time_constant_s(const Resistance<double>& law, double mass_norm, double speed_mps) {
  return mass_norm * speed_mps / law.at(speed_mps);
}

/// Longest integration step h before each sample of the curve, s. T: time constant of the
/// deceleration (time_constant_s()), the smaller of those at the measured speeds before and after
/// the step:
///   - without a filter in the speed sensor, h = T/50. The error of the Runge-Kutta method over one
///     time constant is (h/T)^4/120 of the speed, 1e-9, and 1e-7 if the guess of m' is too large by
///     a factor of 3;
///   - with a filter, h = T/100 for T at the highest speed of all curves, `fall_s`. filtered()
///     takes the speed as linear within a step, an error of (h/T)^2/8 = 1e-5 of the speed.
/// Steps are never below 2 ms, because T is 0 at rest if b < 1. These steps do not depend on the
/// parameters of the search, so that the cost is smooth.
std::vector<double> longest_steps_s(const CoastCurve& curve, const Resistance<double>& law,
                                    double mass_norm, bool has_filter, double fall_s) {
  constexpr double kShortest_s = 2e-3;
  constexpr double kStep = 0.02;
  constexpr double kFilterStep = 0.01;
  const auto step_at = [&](double speed_mps) {
    return speed_mps > 0.0 ? kStep * time_constant_s(law, mass_norm, speed_mps) : 0.0;
  };
  std::vector<double> steps_s;
  steps_s.reserve(curve.speed_mps.size());
  double before_s = std::numeric_limits<double>::infinity();
  for (const double speed_mps : curve.speed_mps) {
    const double now_s = step_at(speed_mps);
    const double step_s = has_filter ? kFilterStep * fall_s : std::min(before_s, now_s);
    steps_s.push_back(std::max(kShortest_s, step_s));
    before_s = now_s;
  }
  return steps_s;
}

/// Smallest time constant T of a filter in a search, s; T = 0 would be a division by 0.
constexpr double kShortestLag_s = 1e-4;

/// Finds the plateau: constant speed before the motors were switched off. The plateau ends at the
/// last sample within 4 standard deviations of the mean of the samples before it. A plateau needs
/// more than eight samples, and at least eight samples after it. The standard deviation of the
/// noise is the root mean square of the second differences over sqrt(6), because second differences
/// of a smooth curve are small.
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
  constexpr std::size_t kFewestFalling = 3;  // as many rows as unknowns: u0, t0 and m'
  if (end >= kShortestPlateau && end + kShortestPlateau < u.size())
    return {{level, curve.t_s[end]}, true, {}};
  CoastInitialState state{{u[0], curve.t_s[0]}, false, {}};
  if (end + kFewestFalling < u.size()) {
    state.short_lead_s = 0.5 * (curve.t_s[end] + curve.t_s[end + 1]);
  }
  return state;
}

}  // namespace

CoastProblem::CoastProblem(const std::vector<CoastCurve>& curves,
                           const TransformedParameters& surge, const CoastStart& start,
                           bool terms_free)
    : curves_(&curves), theta_(surge), at_(start), given_law_(surge) {
  const bool has_filter = start.lag_s > 0.0;
  const Resistance<double> law{std::exp(surge[0]), surge[1], 0.0, surge[2], surge[3]};
  const double mass_norm = std::exp(start.log_mass);
  const double fall_s = fall_time_s(curves, law, start.log_mass);
  initial_.reserve(curves.size());
  for (const CoastCurve& curve : curves) {
    initial_.push_back(initial_state_of(curve));
    auto* cost = new CoastCost(new CoastResidual{.curve = &curve,
                                                 .longest_step_s = longest_steps_s(
                                                     curve, law, mass_norm, has_filter, fall_s),
                                                 .derivative_wanted = terms_free,
                                                 .has_filter = has_filter},
                               static_cast<int>(curve.t_s.size()));
    problem_.AddResidualBlock(cost, nullptr, &theta_[0], &theta_[1], &theta_[2], &theta_[3],
                              &at_.log_mass, &at_.lag_s, initial_.back().block);
    if (!initial_.back().free_time) fix_time(initial_.size() - 1);
    rows_ += rows_of(curve.t_s);
  }
  for (std::size_t i = 0; i < 4; ++i) problem_.SetParameterBlockConstant(&theta_[i]);
  if (has_filter) {
    problem_.SetParameterLowerBound(&at_.lag_s, 0, kShortestLag_s);
  } else {
    problem_.SetParameterBlockConstant(&at_.lag_s);
  }
}

std::vector<double*> CoastProblem::own_blocks() {
  if (at_.lag_s > 0.0) return {log_mass(), lag_s()};
  return {log_mass()};
}

void CoastProblem::free_law(const std::vector<TransformedParameter>& free,
                            const Eigen::MatrixXd& covariance, double noise_mps) {
  const SymmetricEigen parts = symmetric_eigen(covariance);
  law_root_ = parts.values.cwiseSqrt().cwiseInverse().asDiagonal() * parts.vectors.transpose();
  law_free_ = free;
  for (const TransformedParameter c : free) {
    problem_.SetParameterBlockVariable(block(c));
    if (c != TransformedParameter::kLogAlpha) problem_.SetParameterLowerBound(block(c), 0, 0.0);
  }
  problem_.AddResidualBlock(new LawCost(new LawPrior{noise_mps * law_root_, free, given_law_},
                                        static_cast<int>(free.size())),
                            nullptr, &theta_[0], &theta_[1], &theta_[2], &theta_[3]);
}

double CoastProblem::law_distance() const {
  Eigen::VectorXd moved(rows_of(law_free_));
  for (std::size_t i = 0; i < law_free_.size(); ++i) {
    moved(eigen_index(i)) = theta_[at(law_free_[i])] - given_law_[at(law_free_[i])];
  }
  return law_free_.empty() ? 0.0 : (law_root_ * moved).squaredNorm();
}

void CoastProblem::fix_time(std::size_t run) {
  initial_[run].free_time = false;
  initial_[run].block[1] = (*curves_)[run].t_s.front();
  problem_.SetManifold(initial_[run].block, new ceres::SubsetManifold(2, {1}));
}

void CoastProblem::minimise() {
  // A last step of 1e-10 of the parameters, or of 1e-5 standard errors (100 rows), changes no digit
  // that is printed. The tolerances of exact_options() need twice as many steps.
  ceres::Solver::Options options = exact_options();
  options.parameter_tolerance = 1e-10;
  options.function_tolerance = 1e-12;
  ceres::Solver::Options quick = options;
  quick.max_num_line_search_step_size_iterations = 0;  // twice as fast as with line searches
  ceres::Solve(quick, &problem_, &summary_);
  if (!summary_.IsSolutionUsable()) ceres::Solve(options, &problem_, &summary_);
}

void CoastProblem::search() {
  minimise();
  // If the fitted t0 is before the first sample, the record has no plateau and the curve does not
  // separate t0 from u0. The search then fixes t0 at the first sample.
  bool again = false;
  for (std::size_t i = 0; i < initial_.size(); ++i) {
    if (!initial_[i].free_time || initial_[i].block[1] > (*curves_)[i].t_s.front()) continue;
    initial_[i].block[0] = (*curves_)[i].speed_mps.front();
    fix_time(i);
    again = true;
  }
  if (again) minimise();
}

void CoastProblem::solve() {
  search();
  free_short_leads();
}

/// Also fits t0 of the runs without a detected plateau. Keeps this fit if it is usable and lowers
/// AIC; else restores the fit with t0 fixed at the first sample.
void CoastProblem::free_short_leads() {
  constexpr double kOfAic = 2.0;  // penalty in AIC for each fitted t0
  const std::vector<CoastInitialState> fixed = initial_;
  const TransformedParameters theta = theta_;
  const CoastStart at = at_;
  const ceres::Solver::Summary summary = summary_;
  for (CoastInitialState& run : initial_) {
    if (!run.short_lead_s) continue;
    run.block[1] = *run.short_lead_s;
    run.free_time = true;
    problem_.SetManifold(run.block, nullptr);
  }
  const auto free_times = [](const std::vector<CoastInitialState>& runs) {
    return std::ranges::count_if(runs, &CoastInitialState::free_time);
  };
  if (free_times(initial_) == free_times(fixed)) return;
  search();
  const auto more = static_cast<double>(free_times(initial_) - free_times(fixed));
  const double gain =
      static_cast<double>(rows_) * std::log(summary.final_cost / summary_.final_cost);
  if (more > 0.0 && gain > kOfAic * more && summary_.IsSolutionUsable()) return;
  theta_ = theta;
  at_ = at;
  summary_ = summary;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!fixed[i].free_time) fix_time(i);
    initial_[i] = fixed[i];
  }
}

int CoastProblem::free_count() const {
  auto count = static_cast<int>(initial_.size()) + (at_.lag_s > 0.0 ? 2 : 1);
  for (const CoastInitialState& run : initial_) count += run.free_time ? 1 : 0;
  return count;
}

std::optional<Eigen::VectorXd> CoastProblem::residuals() {
  std::optional<Eigen::VectorXd> all = evaluated_residuals(problem_, {});
  if (all) all->conservativeResize(rows_);  // without those of the prior
  return all;
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
  for (double* own : own_blocks()) *own += by(next++);
  if (at_.lag_s > 0.0) at_.lag_s = std::max(at_.lag_s, kShortestLag_s);
  for (CoastInitialState& initial : initial_) {
    initial.block[0] += by(next++);
    if (initial.free_time) initial.block[1] += by(next++);
  }
}

double highest_speed_mps(const std::vector<CoastCurve>& curves) {
  double highest_mps = 0.0;
  for (const CoastCurve& curve : curves) {
    highest_mps = std::max(highest_mps, std::ranges::max(curve.speed_mps));
  }
  return highest_mps;
}

double fall_time_s(const std::vector<CoastCurve>& curves, const Resistance<double>& law,
                   double log_mass) {
  const double highest_mps = highest_speed_mps(curves);
  return time_constant_s(law, std::exp(log_mass), highest_mps);
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
