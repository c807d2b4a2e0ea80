/// Solver settings and helpers for all fits by Ceres. Private to identify/.
#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/statistics/silent_ceres.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// Solver options for small problems: iterates until the parameters stop changing.
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

/// Residuals at the problem's current point. Empty if one of them cannot be evaluated or is not
/// finite. (Ceres itself would leave out the residual blocks that it cannot evaluate.)
inline std::optional<Eigen::VectorXd> evaluated_residuals(
    ceres::Problem& problem, const ceres::Problem::EvaluateOptions& options) {
  std::vector<double> values;
  if (!problem.Evaluate(options, nullptr, &values, nullptr, nullptr)) return std::nullopt;
  if (eigen_index(values.size()) != problem.NumResiduals()) return std::nullopt;
  const Eigen::VectorXd residuals = Eigen::Map<Eigen::VectorXd>(values.data(), rows_of(values));
  if (!residuals.allFinite()) return std::nullopt;
  return residuals;
}

/// Jacobian of the residuals at the problem's current point, as a dense matrix. Empty if an element
/// cannot be evaluated or is not finite.
inline std::optional<Eigen::MatrixXd> evaluated_jacobian(
    ceres::Problem& problem, const ceres::Problem::EvaluateOptions& options) {
  ceres::CRSMatrix rows;
  if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &rows)) return std::nullopt;
  if (rows.num_rows != problem.NumResiduals()) return std::nullopt;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows.num_rows, rows.num_cols);
  for (int i = 0; i < rows.num_rows; ++i) {
    for (std::size_t k = at(rows.rows[at(i)]); k < at(rows.rows[at(i + 1)]); ++k) {
      matrix(i, rows.cols[k]) = rows.values[k];
    }
  }
  if (!matrix.allFinite()) return std::nullopt;
  return matrix;
}

/// Stop reason of a search that converged to a point at which the model's values are not finite.
inline constexpr const char* kNotFinite =
    "failed: the curve or its derivatives are not finite where the search ended";

inline bool converged(const ceres::Solver::Summary& summary) {
  return summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE;
}

}  // namespace awmr

namespace ceres {

/// Value of a Jet (a number that carries its derivatives) as a plain number. The function is in the
/// namespace ceres so that argument-dependent lookup finds it.
template <class T, int N>
T value_of(const Jet<T, N>& x) {
  return x.a;
}

}  // namespace ceres
