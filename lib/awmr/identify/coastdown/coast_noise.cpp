#include "awmr/identify/coastdown/coast_noise.h"

#include <cmath>
#include <limits>

#include "awmr/core/distributions.h"
#include "awmr/core/linear_algebra.h"

namespace awmr {
namespace {

/// Lag-one correlation of the residuals, pooled over the runs.
double lag_one(const Eigen::VectorXd& e, const std::vector<int>& sizes) {
  double products = 0.0;
  double squares = 0.0;
  Eigen::Index row = 0;
  for (const int size : sizes) {
    for (int i = 0; i < size; ++i, ++row) {
      squares += e(row) * e(row);
      if (i > 0) products += e(row) * e(row - 1);
    }
  }
  return squares > 0.0 ? products / squares : 0.0;
}

/// J^T Sigma J/sigma^2 for errors with the covariance Sigma: variance sigma^2, correlation
/// phi^|i - j| between samples i and j of a run, 0 between runs. With the rows J_i, by recursion:
///   y_i = phi (y_{i-1} + J_{i-1}),  sum_i J_i J_i^T + J_i y_i^T + y_i J_i^T
Eigen::MatrixXd correlated_information(const Eigen::MatrixXd& j, const std::vector<int>& sizes,
                                       double phi) {
  Eigen::MatrixXd sum = j.transpose() * j;
  Eigen::Index row = 0;
  for (const int size : sizes) {
    Eigen::RowVectorXd y = Eigen::RowVectorXd::Zero(j.cols());
    for (int i = 0; i < size; ++i, ++row) {
      if (i > 0) y = phi * (y + j.row(row - 1));
      sum += j.row(row).transpose() * y + y.transpose() * j.row(row);
    }
  }
  return sum;
}

/// Sets rank and condition number of J with its columns scaled to length 1, so that neither depends
/// on units.
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

std::vector<std::vector<double>> by_run(const Eigen::VectorXd& e, const std::vector<int>& sizes) {
  std::vector<std::vector<double>> runs;
  const double* first = e.data();
  for (const int size : sizes) {
    runs.emplace_back(first, first + size);
    first += size;
  }
  return runs;
}

Eigen::MatrixXd add_coast_noise(const Eigen::MatrixXd& j, const Eigen::VectorXd& e,
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
      solve_ldlt(j.transpose() * j, Eigen::MatrixXd::Identity(j.cols(), j.cols()));
  return variance * inverse * correlated_information(j, sizes, phi) * inverse;
}

}  // namespace awmr
