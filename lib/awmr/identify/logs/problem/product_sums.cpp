#include "awmr/identify/logs/problem/product_sums.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/logs/simulation/sensitivity_kernel.h"

namespace awmr {
namespace {

constexpr std::size_t kWaiting = 32;  // number of rows in the buffer

}  // namespace

ProductSums::ProductSums(std::size_t size)
    : size_(size),
      columns_((size + kRowVector - 1) / kRowVector * kRowVector),
      rows_(kWaiting * columns_),
      sums_(columns_ * columns_, 0.0),
      gradient_(Eigen::VectorXd::Zero(eigen_index(size - 1))) {}

void ProductSums::add(const double* row) {
  std::copy_n(row, columns_, rows_.begin() + eigen_index(waiting_ * columns_));
  if (++waiting_ == kWaiting) flush();
}

void ProductSums::flush() {
  add_products(rows_.data(), waiting_, columns_, sums_.data());
  waiting_ = 0;
}

Eigen::VectorXd ProductSums::take_gradient() {
  flush();
  Eigen::VectorXd now(gradient_.size());
  for (Eigen::Index i = 0; i < now.size(); ++i) now(i) = sums_[at(i) * columns_ + size_ - 1];
  const Eigen::VectorXd since = now - gradient_;
  gradient_ = now;
  return since;
}

Eigen::MatrixXd ProductSums::products() {
  flush();
  Eigen::MatrixXd all(eigen_index(size_), eigen_index(size_));
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t j = i; j < size_; ++j) {
      all(eigen_index(i), eigen_index(j)) = all(eigen_index(j), eigen_index(i)) =
          sums_[i * columns_ + j];
    }
  }
  return all;
}

Triangle triangle_of(const Eigen::MatrixXd& products) {
  constexpr double kOpen = 1e-14;
  const Eigen::Index m = products.rows() - 1;
  Eigen::VectorXd scale(m);
  for (Eigen::Index i = 0; i < m; ++i) scale(i) = std::max(std::sqrt(products(i, i)), 1e-150);
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  const Eigen::MatrixXd scaled =
      inverse.asDiagonal() * products.topLeftCorner(m, m) * inverse.asDiagonal();
  const Ldlt ldlt = factor_ldlt(scaled);
  const Eigen::VectorXd root =
      (ldlt.diagonal.array() > kOpen).select(ldlt.diagonal.array().abs().sqrt(), 0.0);
  const Eigen::VectorXd gradient =
      ldlt.permutation * (inverse.asDiagonal() * products.col(m).head(m));
  // The decomposition of the scaled matrix is P^T L D L^T P, with a permutation matrix P, a unit
  // lower triangular matrix L and a diagonal matrix D.
  const Eigen::MatrixXd factor =
      ldlt.permutation.transpose() * (ldlt.lower * root.asDiagonal()).eval();
  Triangle t;
  t.r = factor.transpose() * scale.asDiagonal();
  t.z = ldlt.lower.triangularView<Eigen::UnitLower>().solve(gradient);
  for (Eigen::Index i = 0; i < m; ++i) t.z(i) = root(i) > 0.0 ? t.z(i) / root(i) : 0.0;
  t.rest = std::sqrt(std::max(0.0, products(m, m) - t.z.squaredNorm()));
  return t;
}

}  // namespace awmr
