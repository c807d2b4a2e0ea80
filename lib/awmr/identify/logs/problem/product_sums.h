/// Reduces the matrix M = [J r], a Jacobian with its residuals, to the small matrix M^T M, which is
/// summed row by row and then factored into a triangle. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace awmr {

/// Sums M^T M of a matrix M = [J r] row by row. The residuals r are the last column of M.
class ProductSums {
 public:
  /// `size`: number of columns of M.
  explicit ProductSums(std::size_t size);
  /// Length of a row in memory: the number of columns of M, rounded up to a multiple of kRowVector.
  /// The caller fills the rest of each row with 0.
  std::size_t columns() const { return columns_; }
  void add(const double* row);
  /// Returns J^T r of the rows that were added since the last call.
  Eigen::VectorXd take_gradient();
  /// M^T M as a full symmetric matrix.
  Eigen::MatrixXd products();

 private:
  void flush();
  std::size_t size_;
  std::size_t columns_;
  std::size_t waiting_ = 0;   ///< number of buffered rows
  std::vector<double> rows_;  ///< buffer, [kWaiting][columns]
  std::vector<double> sums_;  ///< [columns][columns]
  Eigen::VectorXd gradient_;  ///< J^T r at the last call
};

/// Matrix T = [R z; 0 rest], which replaces M = [J r] in least squares, because T^T T = M^T M. T
/// has only one row more than J has columns. R is triangular up to a permutation of its columns.
struct Triangle {
  Eigen::MatrixXd r;
  Eigen::VectorXd z;
  double rest = 0.0;  ///< norm of the residuals that remain at the optimum
};
/// Computes the triangle from M^T M by a pivoted L D L^T decomposition with columns scaled to
/// length 1. A pivot below 1e-14 becomes 0, because the rows then do not determine its direction.
Triangle triangle_of(const Eigen::MatrixXd& products);

}  // namespace awmr
