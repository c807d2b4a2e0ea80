#include "awmr/identify/coastdown/coast_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/uncertainty/quantiles.h"

namespace awmr {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// u after `tau_s` from u0 by the closed form, a power law with k = a/m':
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
  // ln(1 - x)/s = -z (1 + x/2 + x^2/3 + x^3/4 + ...); the next term is below 1e-17 of it
  if (x < T(kSmall) && x > T(-kSmall)) {
    return u0 * exp(-z * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0)))));
  }
  return u0 * exp(log(1.0 - x) / s);
}

/// One classical Runge-Kutta step of m' u_dot = -g(u); at rest it stays.
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

/// The residuals of one curve over (ln a, b, c, q, ln m', (u0, t0)).
struct CoastResidual {
  const CoastCurve* curve;
  double longest_step_s;

  template <class T>
  bool operator()(const T* log_alpha, const T* beta, const T* coulomb, const T* quadratic,
                  const T* log_mass, const T* start, T* residual) const {
    using std::exp;
    const bool closed =
        value_of(*coulomb) == 0.0 && value_of(*quadratic) == 0.0 && !derivative_wanted;
    const T k = exp(*log_alpha - *log_mass);
    const Resistance<T> law{exp(*log_alpha), *beta, T(0.0), *coulomb, *quadratic};
    const T mass = exp(*log_mass);
    T u = start[0];
    T at_s = start[1];
    for (std::size_t i = 0; i < curve->t_s.size(); ++i) {
      const double t_s = curve->t_s[i];
      if (T(t_s) > start[1]) {
        if (closed) {
          u = coasted(start[0], *beta, k, T(T(t_s) - start[1]));
        } else {
          const int steps = 1 + static_cast<int>((t_s - value_of(at_s)) / longest_step_s);
          const T h = (T(t_s) - at_s) / static_cast<double>(steps);
          for (int n = 0; n < steps; ++n) u = coast_step(law, mass, u, h);
          at_s = T(t_s);
        }
      }
      residual[i] = u - curve->speed_mps[i];
    }
    return true;
  }

  bool derivative_wanted = false;  ///< by c or q, which the closed form does not know
};

using Cost = ceres::AutoDiffCostFunction<CoastResidual, ceres::DYNAMIC, 1, 1, 1, 1, 1, 2>;

/// RK4 at this step errs by (h/T)^4/120 a time constant, below 1e-6 of the speed for T > 0.05 s.
constexpr double kLongestStep_s = 2e-3;

/// Where a run starts: its plateau's mean and end, if it was recorded from before motors-off.
struct RunStart {
  double block[2];  ///< u0 in m/s, t0 in s
  bool free_time = false;
};

/// The noise is seen in second differences, which a smooth curve does not have; the plateau ends at
/// the last sample within 4 of its deviations of the mean of the first ones.
RunStart run_start(const CoastCurve& curve) {
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

/// All curves in one Ceres problem, with the surge rows where asked.
class CoastSearch {
 public:
  CoastSearch(const std::vector<CoastCurve>& curves, const TransformedParameters& surge, double log_mass,
              bool terms_free)
      : curves_(&curves), theta_(surge), log_mass_(log_mass) {
    starts_.reserve(curves.size());
    for (const CoastCurve& curve : curves) {
      starts_.push_back(run_start(curve));
      auto* cost = new Cost(
          new CoastResidual{
              .curve = &curve, .longest_step_s = kLongestStep_s, .derivative_wanted = terms_free},
          static_cast<int>(curve.t_s.size()));
      double* start = starts_.back().block;
      problem_.AddResidualBlock(cost, nullptr, &theta_[0], &theta_[1], &theta_[2], &theta_[3],
                                &log_mass_, start);
      if (!starts_.back().free_time) {
        problem_.SetManifold(start, new ceres::SubsetManifold(2, {1}));
      }
      sizes_.push_back(static_cast<int>(curve.t_s.size()));
    }
    for (std::size_t i = 0; i < 4; ++i) problem_.SetParameterBlockConstant(&theta_[i]);
  }

  ceres::Problem& problem() { return problem_; }
  double* block(TransformedParameter c) { return &theta_[static_cast<std::size_t>(c)]; }
  double* log_mass() { return &log_mass_; }
  const TransformedParameters& theta() const { return theta_; }

  void solve() {
    ceres::Solve(exact_options(), &problem_, &summary_);
    // Before the first sample u0 and t0 are one number: such a run has no plateau after all.
    bool again = false;
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      RunStart& start = starts_[i];
      const double first_s = (*curves_)[i].t_s.front();
      if (!start.free_time || start.block[1] > first_s) continue;
      start = {{(*curves_)[i].speed_mps.front(), first_s}, false};
      problem_.SetManifold(start.block, new ceres::SubsetManifold(2, {1}));
      again = true;
    }
    if (again) ceres::Solve(exact_options(), &problem_, &summary_);
  }
  const ceres::Solver::Summary& summary() const { return summary_; }

  Eigen::VectorXd residuals() {
    std::vector<double> values;
    problem_.Evaluate({}, nullptr, &values, nullptr, nullptr);
    return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  /// Columns: `first` in order, then each run's start (u0, and t0 where free).
  Eigen::MatrixXd jacobian(const std::vector<double*>& first) {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = first;
    for (RunStart& start : starts_) options.parameter_blocks.push_back(start.block);
    for (double* block : first) problem_.SetParameterBlockVariable(block);
    ceres::CRSMatrix rows;
    problem_.Evaluate(options, nullptr, nullptr, nullptr, &rows);
    return dense(rows);
  }

  /// Moves theta, ln m' and each run's start, in that order.
  void step(const std::vector<TransformedParameter>& free, const Eigen::VectorXd& by) {
    Eigen::Index at = 0;
    for (const TransformedParameter c : free) *block(c) += by(at++);
    log_mass_ += by(at++);
    for (RunStart& start : starts_) {
      start.block[0] += by(at++);
      if (start.free_time) start.block[1] += by(at++);
    }
  }

  const std::vector<int>& sizes() const { return sizes_; }

 private:
  const std::vector<CoastCurve>* curves_;
  TransformedParameters theta_;
  double log_mass_;
  std::vector<RunStart> starts_;
  std::vector<int> sizes_;
  ceres::Problem problem_;
  ceres::Solver::Summary summary_;
};

/// Deceleration at the start of the curves against g1 there: m' ~ g(u) dt/du.
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

/// Lag-one correlation of the residuals, pooled over the runs.
double lag_one(const Eigen::VectorXd& e, const std::vector<int>& sizes) {
  double products = 0.0;
  double squares = 0.0;
  Eigen::Index at = 0;
  for (const int size : sizes) {
    for (int i = 0; i < size; ++i, ++at) {
      squares += e(at) * e(at);
      if (i > 0) products += e(at) * e(at - 1);
    }
  }
  return squares > 0.0 ? products / squares : 0.0;
}

/// J^T Sigma J over sigma^2 for errors of correlation phi^|i - j| within a run, by recursion:
///   y_i = phi (y_{i-1} + J_{i-1}),  sum_i J_i J_i^T + J_i y_i^T + y_i J_i^T
Eigen::MatrixXd correlated_information(const Eigen::MatrixXd& j, const std::vector<int>& sizes,
                                       double phi) {
  Eigen::MatrixXd sum = j.transpose() * j;
  Eigen::Index at = 0;
  for (const int size : sizes) {
    Eigen::RowVectorXd y = Eigen::RowVectorXd::Zero(j.cols());
    for (int i = 0; i < size; ++i, ++at) {
      if (i > 0) y = phi * (y + j.row(at - 1));
      sum += j.row(at).transpose() * y + y.transpose() * j.row(at);
    }
  }
  return sum;
}

std::vector<std::vector<double>> by_run(const Eigen::VectorXd& e, const std::vector<int>& sizes) {
  std::vector<std::vector<double>> runs;
  const double* at = e.data();
  for (const int size : sizes) {
    runs.emplace_back(at, at + size);
    at += size;
  }
  return runs;
}

/// Rank and condition of J with its columns scaled to length one: units do not matter.
void add_rank(const Eigen::MatrixXd& j, CoastFit& fit) {
  Eigen::MatrixXd scaled = j;
  for (Eigen::Index c = 0; c < j.cols(); ++c) {
    const double length = scaled.col(c).norm();
    if (length > 0.0) scaled.col(c) /= length;
  }
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues();
  const double least = singular(singular.size() - 1);
  fit.condition_number = least > 0.0 ? singular(0) / least : kInfinity;
  fit.rank = static_cast<int>((singular.array() > 1e-9 * singular(0)).count());
}

/// Noise, colour, covariance of the first `kept` columns of J. Nothing without degrees of freedom.
Eigen::MatrixXd add_noise(const Eigen::MatrixXd& j, const Eigen::VectorXd& e,
                          const std::vector<int>& sizes, CoastFit& fit) {
  const auto n = static_cast<double>(e.size());
  fit.rows = static_cast<int>(e.size());
  fit.residuals = by_run(e, sizes);
  add_rank(j, fit);
  if (fit.rank < j.cols() || n <= static_cast<double>(j.cols())) return {};
  const double variance = e.squaredNorm() / (n - static_cast<double>(j.cols()));
  fit.residual_std_mps = std::sqrt(variance);
  double phi = lag_one(e, sizes);
  fit.autocorrelated = phi * std::sqrt(n) > kNormalQuantile995;
  if (!fit.autocorrelated) phi = 0.0;
  fit.dof = (n - static_cast<double>(j.cols())) * (1.0 - phi) / (1.0 + phi);
  const Eigen::MatrixXd inverse =
      (j.transpose() * j).ldlt().solve(Eigen::MatrixXd::Identity(j.cols(), j.cols()));
  return variance * inverse * correlated_information(j, sizes, phi) * inverse;
}

}  // namespace

CoastFit fit_coast(const std::vector<CoastCurve>& curves, const SteadyFit& surge) {
  const bool terms = surge.law().coulomb > 0.0 || surge.law().quadratic > 0.0;
  CoastSearch search(curves, surge.theta, guess_log_mass(curves, surge.law()), terms);
  search.solve();
  CoastFit fit;
  fit.log_mass_norm = *search.log_mass();
  fit.stop_reason = stop_reason(search.summary());
  fit.beta = surge[TransformedParameter::kBeta];
  const Eigen::VectorXd e = search.residuals();
  const Eigen::MatrixXd j = search.jacobian({search.log_mass()});
  const Eigen::MatrixXd covariance = add_noise(j, e, search.sizes(), fit);
  if (covariance.size() == 0 || !converged(search.summary())) return fit;
  fit.variance = covariance(0, 0);
  fit.usable = true;
  // At the optimum J^T e = 0 for every theta, so d(ln m', starts)/d theta = -J^+ d e/d theta; a
  // dead zone does not enter: the motors are off.
  fit.by_surge = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(surge.free.size()));
  std::vector<double*> blocks;
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < surge.free.size(); ++i) {
    if (surge.free[i] == TransformedParameter::kDeadZone) continue;
    blocks.push_back(search.block(surge.free[i]));
    places.push_back(static_cast<Eigen::Index>(i));
  }
  const Eigen::MatrixXd by_theta =
      search.jacobian(blocks).leftCols(static_cast<Eigen::Index>(blocks.size()));
  const Eigen::MatrixXd moves = -j.colPivHouseholderQr().solve(by_theta);
  for (std::size_t i = 0; i < places.size(); ++i) {
    fit.by_surge(places[i]) = moves(0, static_cast<Eigen::Index>(i));
  }
  return fit;
}

CoastFit fit_coast_alone(const std::vector<CoastCurve>& curves, const Interval& beta_range) {
  const TransformedParameters unit{0.0, std::clamp(0.8, beta_range.lo, beta_range.hi), 0.0, 0.0, 0.0};
  CoastSearch search(curves, unit, guess_log_mass(curves, {1.0, unit[1]}), false);
  double* beta = search.block(TransformedParameter::kBeta);
  search.problem().SetParameterBlockVariable(beta);
  search.problem().SetParameterLowerBound(beta, 0, beta_range.lo);
  search.problem().SetParameterUpperBound(beta, 0, beta_range.hi);
  search.solve();
  CoastFit fit;
  fit.log_mass_norm = *search.log_mass();
  fit.beta = *beta;
  fit.stop_reason = stop_reason(search.summary());
  constexpr double kAtBound = 1e-9;
  const bool at_bound =
      fit.beta <= beta_range.lo + kAtBound || fit.beta >= beta_range.hi - kAtBound;
  std::vector<double*> blocks{search.log_mass()};
  if (!at_bound) blocks.push_back(beta);
  const Eigen::MatrixXd covariance =
      add_noise(search.jacobian(blocks), search.residuals(), search.sizes(), fit);
  if (covariance.size() == 0 || !converged(search.summary())) return fit;
  fit.variance = covariance(0, 0);
  if (!at_bound) fit.beta_variance = covariance(1, 1);
  fit.usable = true;
  return fit;
}

namespace {

/// What the joint fit knows at one pair of noise levels.
struct Stacked {
  Eigen::MatrixXd surge;  ///< J of the surge rows over all columns
  Eigen::MatrixXd coast;
  Eigen::MatrixXd covariance;
};

Stacked stack(const SteadyRows& rows, const Eigen::MatrixXd& coast_j,
              const std::vector<Eigen::Index>& coast_columns, double surge_variance,
              double coast_variance) {
  const auto p = static_cast<Eigen::Index>(rows.jacobian.cols());
  const Eigen::Index own = coast_j.cols() - static_cast<Eigen::Index>(coast_columns.size());
  Stacked stacked;
  stacked.surge = Eigen::MatrixXd::Zero(rows.residuals.size(), p + own);
  stacked.surge.leftCols(p) = rows.jacobian;
  stacked.coast = Eigen::MatrixXd::Zero(coast_j.rows(), p + own);
  for (std::size_t i = 0; i < coast_columns.size(); ++i) {
    stacked.coast.col(coast_columns[i]) = coast_j.col(static_cast<Eigen::Index>(i));
  }
  stacked.coast.rightCols(own) = coast_j.rightCols(own);
  const Eigen::MatrixXd information = stacked.surge.transpose() * stacked.surge / surge_variance +
                                      stacked.coast.transpose() * stacked.coast / coast_variance;
  stacked.covariance = information.ldlt().solve(Eigen::MatrixXd::Identity(p + own, p + own));
  return stacked;
}

}  // namespace

JointFit fit_joint(const SteadyProblem& problem, const SteadyFit& start,
                   const std::vector<CoastCurve>& curves) {
  JointFit joint;
  joint.surge = start;
  const bool terms = terms_of(problem.family).coulomb || terms_of(problem.family).quadratic;
  CoastSearch search(curves, start.theta, fit_coast(curves, start).log_mass_norm, terms);
  search.solve();               // each run's start
  std::vector<double*> shared;  // blocks that the curves know, by column of the surge rows
  std::vector<Eigen::Index> coast_columns;
  for (std::size_t i = 0; i < start.free.size(); ++i) {
    if (start.free[i] == TransformedParameter::kDeadZone) continue;
    shared.push_back(search.block(start.free[i]));
    coast_columns.push_back(static_cast<Eigen::Index>(i));
  }
  double surge_variance = start.residual_std * start.residual_std;
  double coast_variance = 0.0;
  {
    const Eigen::VectorXd e = search.residuals();
    coast_variance = e.squaredNorm() / static_cast<double>(e.size());
  }
  // Gauss-Newton on the stacked rows; the noise levels are those of the last step's residuals. Both
  // settle together.
  constexpr int kMostRounds = 200;
  for (int round = 0; round < kMostRounds; ++round) {
    joint.surge.theta = search.theta();
    const SteadyRows rows = steady_rows(problem, joint.surge.theta, joint.surge.free);
    std::vector<double*> blocks = shared;
    blocks.push_back(search.log_mass());
    const Eigen::MatrixXd coast_j = search.jacobian(blocks);
    const Eigen::VectorXd coast_e = search.residuals();
    const Stacked s = stack(rows, coast_j, coast_columns, surge_variance, coast_variance);
    const Eigen::VectorXd step =
        -s.covariance * (s.surge.transpose() * rows.residuals / surge_variance +
                         s.coast.transpose() * coast_e / coast_variance);
    // What each set of rows spends on the parameters.
    const double surge_spent =
        (s.covariance * (s.surge.transpose() * s.surge)).trace() / surge_variance;
    const double coast_spent =
        (s.covariance * (s.coast.transpose() * s.coast)).trace() / coast_variance;
    const double surge_dof = static_cast<double>(rows.residuals.size()) - surge_spent;
    const double coast_dof = static_cast<double>(coast_e.size()) - coast_spent;
    const auto p = static_cast<Eigen::Index>(joint.surge.free.size());
    joint.covariance = s.covariance.topLeftCorner(p + 1, p + 1);
    joint.dof = Eigen::VectorXd::Zero(p + 1);
    const Eigen::MatrixXd by_surge =
        s.covariance * (s.surge.transpose() * s.surge) * s.covariance / surge_variance;
    const Eigen::MatrixXd by_coast =
        s.covariance * (s.coast.transpose() * s.coast) * s.covariance / coast_variance;
    for (Eigen::Index i = 0; i <= p; ++i) {
      const double total = by_surge(i, i) + by_coast(i, i);
      joint.dof(i) = total * total /
                     (by_surge(i, i) * by_surge(i, i) / std::max(1.0, surge_dof) +
                      by_coast(i, i) * by_coast(i, i) / std::max(1.0, coast_dof));
    }
    joint.log_mass_norm = *search.log_mass();
    joint.coast.residuals = by_run(coast_e, search.sizes());
    joint.coast.residual_std_mps = std::sqrt(coast_variance);
    joint.coast.rows = static_cast<int>(coast_e.size());
    const double new_surge = rows.residuals.squaredNorm() / std::max(1.0, surge_dof);
    const double new_coast = coast_e.squaredNorm() / std::max(1.0, coast_dof);
    const double change = std::max(std::abs(new_surge / surge_variance - 1.0),
                                   std::abs(new_coast / coast_variance - 1.0));
    surge_variance = new_surge;
    coast_variance = new_coast;
    const double length = (step.array() / s.covariance.diagonal().array().sqrt()).abs().maxCoeff();
    if (length < 1e-8 && change < 1e-8) {
      joint.coast.usable = true;
      joint.coast.stop_reason = "converged: steps below 1e-8 standard errors";
      joint.surge.residual_std = std::sqrt(surge_variance);
      joint.surge.residuals = rows.residuals;
      break;
    }
    search.step(start.free, step);
    joint.coast.stop_reason = "not converged: the step is still above 1e-8 standard errors";
  }
  joint.surge.covariance =
      joint.covariance.topLeftCorner(joint.covariance.rows() - 1, joint.covariance.cols() - 1);
  joint.surge.stop_reason = joint.coast.stop_reason;
  return joint;
}

}  // namespace awmr
