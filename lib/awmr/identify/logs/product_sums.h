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
  /// The length of a row as it is added: `size` and zeros up to a whole number of vectors.
  std::size_t columns() const { return columns_; }
  void add(const double* row);
  /// J^T r of the rows since the last call.
  Eigen::VectorXd take_gradient();
  /// M^T M, both halves of it.
  Eigen::MatrixXd products();

 private:
  void flush();
  std::size_t size_;
  std::size_t columns_;
  std::size_t waiting_ = 0;   ///< rows
  std::vector<double> rows_;  ///< of them, [kWaiting][columns]
  std::vector<double> sums_;  ///< [columns][columns]
  Eigen::VectorXd gradient_;  ///< J^T r when it was last taken
};

/// Few rows in place of many: [R z; 0 rest] has the same M^T M, so that for a search it is the same.
struct Triangle {
  Eigen::MatrixXd r;
  Eigen::VectorXd z;
  double rest = 0.0;  ///< norm of the residual that no step removes
};
/// By L D L^T with pivots of the products, columns scaled to 1; a pivot below 1e-14 is a direction that
/// the rows do not show.
Triangle triangle_of(const Eigen::MatrixXd& products);

}  // namespace awmr
