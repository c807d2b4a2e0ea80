/// Sums of products of rows, and a triangular matrix equivalent to the rows. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace awmr {

/// M^T M of a matrix M = [J r] that is given row by row; r is its last column.
class ProductSums {
 public:
  explicit ProductSums(std::size_t size);
  /// Padded length of a row: `size` rounded up to whole vectors; the rest is 0.
  std::size_t columns() const { return columns_; }
  void add(const double* row);
  /// J^T r of the rows since the last call.
  Eigen::VectorXd take_gradient();
  /// M^T M, both triangles.
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

/// Equivalent of the rows for least squares: [R z; 0 rest] has the same M^T M.
struct Triangle {
  Eigen::MatrixXd r;
  Eigen::VectorXd z;
  double rest = 0.0;  ///< norm of the residual that no step reduces
};
/// By L D L^T with pivots of the products, columns scaled to 1; a pivot below 1e-14 is a direction
/// that the rows do not determine.
Triangle triangle_of(const Eigen::MatrixXd& products);

}  // namespace awmr
