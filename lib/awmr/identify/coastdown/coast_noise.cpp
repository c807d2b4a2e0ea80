#include "awmr/identify/coastdown/coast_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/logs/problem/whitener.h"

namespace awmr {
namespace {

/// Returns J^T R J, with the Jacobian J of the residuals and the correlation matrix R of their
/// errors. The errors are white noise and a drift; those of different curves are independent.
/// (Differenced noise counts as white, which makes intervals wider.) J_i is row i of J, and s the
/// share of the drift in the variance. F_i is the transition matrix of the drift from row i-1 to
/// row i (DriftStep), e_0 the first unit vector. The recursion is
///   Y_i = F_i (Y_{i-1} + e_0 J_{i-1}),
///   J^T R J = sum_i J_i^T J_i + s (J_i^T (e_0^T Y_i) + (e_0^T Y_i)^T J_i)
Eigen::MatrixXd correlated_information(const Eigen::MatrixXd& j,
                                       const std::vector<CoastCurve>& curves,
                                       const ChannelNoise& noise) {
  Eigen::MatrixXd sum = j.transpose() * j;
  if (!(noise.drift_std > 0.0)) return sum;
  const double share = std::pow(noise.drift_std / noise.std(), 2);
  Eigen::Index row = 0;
  for (const CoastCurve& curve : curves) {
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(2, j.cols());
    for (std::size_t i = 0; i < curve.t_s.size(); ++i, ++row) {
      if (i > 0) {
        const DriftStep step(noise, curve.t_s[i] - curve.t_s[i - 1]);
        y.row(0) += j.row(row - 1);
        y = Eigen::MatrixXd(
            Eigen::Map<const Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(&step.f[0][0]) * y);
      }
      const Eigen::MatrixXd across = share * j.row(row).transpose() * y.row(0);
      sum += across + across.transpose();
    }
  }
  return sum;
}

/// Sets the rank and the condition number of the fit's Jacobian J. The columns of J are scaled to
/// length 1, so that neither number depends on units.
void add_rank(const Eigen::MatrixXd& j, CoastFit& fit) {
  Eigen::MatrixXd scaled = j;
  for (Eigen::Index c = 0; c < j.cols(); ++c) {
    const double length = scaled.col(c).norm();
    if (length > 0.0) scaled.col(c) /= length;
  }
  const Eigen::VectorXd singular = singular_values(scaled);
  const double minimum = singular(singular.size() - 1);
  fit.condition_number =
      minimum > 0.0 ? singular(0) / minimum : std::numeric_limits<double>::infinity();
  fit.rank = static_cast<int>((singular.array() > 1e-9 * singular(0)).count());
}

}  // namespace

std::vector<std::vector<double>> by_run(const Eigen::VectorXd& e,
                                        const std::vector<CoastCurve>& curves) {
  std::vector<std::vector<double>> runs;
  const double* first = e.data();
  for (const CoastCurve& curve : curves) {
    runs.emplace_back(first, first + curve.t_s.size());
    first += curve.t_s.size();
  }
  return runs;
}

namespace {

/// The residuals `e` as one series per curve.
std::vector<ErrorSeries> series_by_curve(const Eigen::VectorXd& e,
                                         const std::vector<CoastCurve>& curves) {
  std::vector<std::vector<double>> runs = by_run(e, curves);
  std::vector<ErrorSeries> series;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    series.push_back({std::move(runs[run]), {0.0}});
    const std::vector<double>& t_s = curves[run].t_s;
    for (std::size_t i = 1; i < t_s.size(); ++i)
      series.back().since_s.push_back(t_s[i] - t_s[i - 1]);
  }
  return series;
}

}  // namespace

ChannelNoise noise_of_residuals(const Eigen::VectorXd& e, const std::vector<CoastCurve>& curves,
                                int free, double sensor_mps) {
  const std::vector<ErrorSeries> series = series_by_curve(e, curves);
  const auto n = static_cast<double>(e.size());
  const double free_share = (n - static_cast<double>(free)) / n;
  return likeliest_noise(series, free_share,
                         {.sensor_std = sensor_mps, .count = static_cast<int>(e.size())});
}

double cost_of_residuals(const Eigen::VectorXd& e, const std::vector<CoastCurve>& curves,
                         const ChannelNoise& noise) {
  return cost_of(series_by_curve(e, curves), noise);
}

double effective_std(const ChannelNoise& noise, const std::vector<CoastCurve>& curves) {
  Eigen::Index rows = 0;
  for (const CoastCurve& curve : curves) rows += rows_of(curve.t_s);
  const double variance =
      correlated_information(Eigen::MatrixXd::Ones(rows, 1), curves, noise)(0, 0) /
      static_cast<double>(rows);
  return noise.std() * std::sqrt(std::max(1.0, variance));
}

Eigen::MatrixXd add_coast_noise(const Eigen::MatrixXd& j, const Eigen::VectorXd& e,
                                const std::vector<CoastCurve>& curves, CoastFit& fit) {
  const auto n = static_cast<double>(e.size());
  const double dof = n - static_cast<double>(j.cols());
  fit.rows = static_cast<int>(e.size());
  fit.residuals = by_run(e, curves);
  add_rank(j, fit);
  if (fit.rank < j.cols() || dof <= 0.0) return {};
  const ChannelNoise noise = noise_of_residuals(e, curves, static_cast<int>(j.cols()), 0.0);
  fit.residual_std_mps = std::sqrt(e.squaredNorm() / dof);
  fit.autocorrelated = noise.drift_std > 0.0;
  fit.dof = dof * std::pow(noise.std() / effective_std(noise, curves), 2);
  const Eigen::MatrixXd inverse =
      solve_ldlt(j.transpose() * j, Eigen::MatrixXd::Identity(j.cols(), j.cols()));
  return std::pow(fit.residual_std_mps, 2) * inverse * correlated_information(j, curves, noise) *
         inverse;
}

}  // namespace awmr
