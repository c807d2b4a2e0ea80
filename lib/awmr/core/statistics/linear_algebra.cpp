#include "awmr/core/statistics/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace awmr {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd solve_ldlt(const MatrixXd& a, const MatrixXd& b) { return a.ldlt().solve(b); }

Ldlt factor_ldlt(const MatrixXd& a) {
  const Eigen::LDLT<MatrixXd> ldlt(a);
  return {ldlt.matrixL(), ldlt.vectorD(), ldlt.transpositionsP()};
}

SymmetricEigen symmetric_eigen(const MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(a);
  return {eigen.eigenvalues(), eigen.eigenvectors(), eigen.info() == Eigen::Success};
}

VectorXd symmetric_eigenvalues(const MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::VectorXcd eigenvalues(const MatrixXd& a) {
  return Eigen::EigenSolver<MatrixXd>(a, false).eigenvalues();
}

// The singular values of A equal the singular values of R in the pivoted decomposition A Pi = Q R.
// They are computed from R, because Eigen's code for A itself takes 10 s longer to compile.
VectorXd singular_values(const MatrixXd& a) {
  if (a.rows() < a.cols()) return singular_values(a.transpose());
  return Eigen::JacobiSVD<MatrixXd, Eigen::NoQRPreconditioner>(PivotedQr(a).r()).singularValues();
}

PivotedQr::PivotedQr(const MatrixXd& j) : qr_(j) {}

Eigen::Index PivotedQr::rank() const { return qr_.rank(); }

MatrixXd PivotedQr::solve(const MatrixXd& b) const { return qr_.solve(b); }

VectorXd PivotedQr::solve(const VectorXd& b) const { return qr_.solve(b); }

VectorXd PivotedQr::leverages() const {
  const MatrixXd thin = qr_.householderQ() * MatrixXd::Identity(qr_.rows(), qr_.cols());
  return thin.rowwise().squaredNorm();
}

MatrixXd PivotedQr::r() const {
  return qr_.matrixR().topRows(qr_.cols()).triangularView<Eigen::Upper>();
}

MatrixXd PivotedQr::inverse_information() const {
  const Eigen::Index p = qr_.cols();
  const MatrixXd r_inverse = r().triangularView<Eigen::Upper>().solve(MatrixXd::Identity(p, p));
  const MatrixXd pivoted = r_inverse * r_inverse.transpose();
  return qr_.colsPermutation() * pivoted * qr_.colsPermutation().transpose();
}

}  // namespace awmr
