/// What every search with Ceres shares. Private to identify/.
#pragma once

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/Core>
#include <string>

#include "awmr/core/index.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// Ceres says on stderr why it stopped, through its logging library; here that is in the result.
inline void silence_ceres() { FLAGS_minloglevel = google::GLOG_FATAL; }

/// Runs until nothing moves any more: the data are few, the digits cheap.
inline ceres::Solver::Options exact_options() {
  silence_ceres();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  return options;
}

inline std::string stop_reason(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return "converged: " + summary.message;
    case ceres::NO_CONVERGENCE:
      return "not converged: " + summary.message;
    default:
      return "failed: " + summary.message;
  }
}

/// A Jacobian as Ceres hands it out, with its zeros.
inline Eigen::MatrixXd dense(const ceres::CRSMatrix& rows) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows.num_rows, rows.num_cols);
  for (int i = 0; i < rows.num_rows; ++i) {
    for (std::size_t k = at(rows.rows[at(i)]); k < at(rows.rows[at(i + 1)]); ++k) {
      matrix(i, rows.cols[k]) = rows.values[k];
    }
  }
  return matrix;
}

inline bool converged(const ceres::Solver::Summary& summary) {
  return summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE;
}

}  // namespace awmr

namespace ceres {

/// The value of a number that carries derivatives; found by its argument.
template <class T, int N>
T value_of(const Jet<T, N>& x) {
  return x.a;
}

}  // namespace ceres
