/// Joint probability distribution of several estimated numbers: a mixture over alternative
/// assumptions, such as error models. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// Mixture of Student's t distributions. Alternative k has the probability w_k; under it, the
/// numbers x have the centre m_k and the covariance C_k. An empty list of alternatives means that
/// the uncertainty is unknown.
struct Posterior {
  struct Alternative {
    double weight = 1.0;         ///< probability w_k in (0, 1]; all add up to 1
    Eigen::VectorXd centre;      ///< m_k
    Eigen::MatrixXd covariance;  ///< C_k, positive semi-definite
    Eigen::VectorXd dof;         ///< degrees of freedom of each number's variance, > 0
  };
  std::vector<Alternative> alternatives;

  bool empty() const { return alternatives.empty(); }
  /// True if, under every alternative, x_i has a finite centre, a finite variance >= 0 and positive
  /// degrees of freedom.
  bool is_proper(Eigen::Index i) const;
  /// Covariance of x about its mean m = sum w_k m_k:
  ///   C = sum w_k (C_k + (m_k - m)(m_k - m)')
  /// Precondition: not empty.
  Eigen::MatrixXd covariance() const;
  /// The p quantile of x_i. Precondition: not empty, is_proper(i), 0 < p < 1.
  double quantile(Eigen::Index i, double p) const;
};

/// Sets standard error, quantiles and 95 % interval (2.5 % to 97.5 % quantile) of an estimate whose
/// value is already set. `to_value` converts the number x_i of the posterior to the estimate's unit
/// (for example, a logarithm to its value), and must be increasing. `slope`: derivative of this
/// conversion with respect to x_i, at the estimate's value. If the posterior is not proper, the
/// standard error is infinite and there is no interval. An empty posterior changes nothing.
void set_uncertainty(const Posterior& posterior, Eigen::Index i, double slope,
                     const std::function<double(double)>& to_value, Estimate& estimate);

}  // namespace awmr
