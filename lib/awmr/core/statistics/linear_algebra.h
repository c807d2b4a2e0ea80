/// Decompositions of dense double matrices. Use these functions, not those of Eigen, which cost
/// seconds of compile time in every source file. Private: not installed.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>

namespace awmr {

/// Solves A X = B by the decomposition L D L^T with pivoting. A: n x n, symmetric and positive or
/// negative semidefinite; B: n x k.
Eigen::MatrixXd solve_ldlt(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Decomposition P A P^T = L D L^T of a symmetric A.
struct Ldlt {
  Eigen::MatrixXd lower;                              ///< L, unit lower triangular
  Eigen::VectorXd diagonal;                           ///< diagonal of D
  Eigen::Transpositions<Eigen::Dynamic> permutation;  ///< P
};
Ldlt factor_ldlt(const Eigen::MatrixXd& a);

/// Eigenvalues and eigenvectors of a symmetric A = V diag(w) V^T; only its lower triangle is read.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< w, ascending
  Eigen::MatrixXd vectors;  ///< V, one eigenvector per column
  bool converged = false;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);
/// The eigenvalues of a symmetric matrix, ascending, as by symmetric_eigen().
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// Eigenvalues of a square matrix, in no particular order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

/// Singular values, descending.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

/// Decomposition J Pi = Q R with column pivoting (the permutation Pi). J: n x p.
class PivotedQr {
 public:
  explicit PivotedQr(const Eigen::MatrixXd& j);
  Eigen::Index rank() const;
  /// The least-squares solution of J X = B. B: n x k.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Leverages of the n rows of J: the diagonal of Q Q^T, where Q has only its first p columns.
  Eigen::VectorXd leverages() const;
  Eigen::MatrixXd r() const;  ///< R: p x p, upper triangle
  /// The inverse of J^T J, computed as Pi R^-1 R^-T Pi^T. Precondition: rank() == p.
  Eigen::MatrixXd inverse_information() const;

 private:
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
};

}  // namespace awmr
