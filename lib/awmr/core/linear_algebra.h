/// Decompositions of dense double matrices. Eigen's decompositions are instantiated in
/// linear_algebra.cpp only, because they cost seconds of compile time per source. Private: not
/// installed.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>

namespace awmr {

/// Solves A X = B by L D L^T with pivoting. A: n x n, symmetric and positive or negative
/// semidefinite; B: n x k.
Eigen::MatrixXd solve_ldlt(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// P A P^T = L D L^T.
struct Ldlt {
  Eigen::MatrixXd lower;                              ///< L, unit diagonal
  Eigen::VectorXd diagonal;                           ///< of D
  Eigen::Transpositions<Eigen::Dynamic> permutation;  ///< P
};
Ldlt factor_ldlt(const Eigen::MatrixXd& a);

/// A = V diag(w) V^T of a symmetric A; only the lower triangle is read.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< w, ascending
  Eigen::MatrixXd vectors;  ///< V, one per column
  bool converged = false;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);
/// w only.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// Eigenvalues of a square matrix, in no particular order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

/// Singular values, descending.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

/// J Pi = Q R with column pivoting. J: n x p.
class PivotedQr {
 public:
  explicit PivotedQr(const Eigen::MatrixXd& j);
  Eigen::Index rank() const;
  /// The least-squares solution of J X = B. B: n x k.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Leverages, n: the diagonal of Q Q^T over the columns of J.
  Eigen::VectorXd leverages() const;
  Eigen::MatrixXd r() const;            ///< R: p x p, upper triangle
  Eigen::MatrixXd permutation() const;  ///< Pi: p x p
  /// (J^T J)^-1 = Pi R^-1 R^-T Pi^T. Precondition: rank() == p.
  Eigen::MatrixXd inverse_information() const;
  /// As inverse_information(), from the pseudo-inverse J^+, for few rows: J^+ J^+T.
  Eigen::MatrixXd inverse_information_by_pseudo_inverse() const;

 private:
  /// Above this number of rows, Q is computed column by column, because a square Q grows with the
  /// square of the rows.
  static constexpr Eigen::Index kMaxSquareQ = 200;

  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
};

}  // namespace awmr
