/// Joint uncertainty of several numbers, weighted over alternative assumptions.
/// Private to identify/.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// Mixture of Student's t distributions: under alternative k, with probability w_k, the numbers x
/// have the centre m_k and the covariance C_k. Without alternatives the errors are unknown.
struct Posterior {
  struct Alternative {
    double weight = 1.0;         ///< w_k in (0, 1]; they add up to 1
    Eigen::VectorXd centre;      ///< m_k
    Eigen::MatrixXd covariance;  ///< C_k, positive semi-definite
    Eigen::VectorXd dof;         ///< degrees of freedom of each number's variance, > 0
  };
  std::vector<Alternative> alternatives;

  bool empty() const { return alternatives.empty(); }
  /// False if the centre, the variance or the degrees of freedom of x_i are not finite.
  bool is_proper(Eigen::Index i) const;
  /// About the mean m = sum w_k m_k:
  ///   C = sum w_k (C_k + (m_k - m)(m_k - m)')
  /// Precondition: not empty.
  Eigen::MatrixXd covariance() const;
  /// The x_i with P(X_i <= x_i) = p. Precondition: not empty, is_proper(i), 0 < p < 1.
  double quantile(Eigen::Index i, double p) const;
};

/// Sets standard error, 95 % interval (2.5 % to 97.5 % quantile) and quantiles of an estimate from
/// number `i` of a posterior; the value is already set. `to_value` is increasing, `slope` its
/// derivative at the value. If the posterior is not proper, the error is infinite and there is no
/// interval.
void set_uncertainty(const Posterior& posterior, Eigen::Index i, double slope,
                     const std::function<double(double)>& to_value, Estimate& estimate);

}  // namespace awmr
