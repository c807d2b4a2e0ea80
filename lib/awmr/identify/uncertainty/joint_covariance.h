/// Covariance of all identified parameters, assembled from independent fits. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// Every parameter is a function of estimated numbers, which form independent blocks: the
/// coordinates of the surge fit (and ln m'), of the yaw fit, of the log fit, ... The covariance of
/// the parameters is C = G B G^T, with the blocks' covariances on the diagonal of B and the
/// gradient of each parameter in a row of G.
class JointCovariance {
 public:
  /// Derivatives of one parameter by the estimated numbers. Key: index of a number, counted over
  /// all blocks. Derivatives that are not listed are 0.
  using Gradient = std::map<Eigen::Index, double>;

  /// Appends a block and returns the index of its first number.
  Eigen::Index add_block(const Eigen::MatrixXd& covariance);
  /// Sets the gradient of a parameter. Replaces an earlier gradient.
  void set(ParameterId id, Gradient gradient) { gradients_[id] = std::move(gradient); }
  bool has(ParameterId id) const { return gradients_.contains(id); }
  /// Variance of a parameter with this gradient.
  double variance(const Gradient& gradient) const;
  const Gradient& gradient(ParameterId id) const { return gradients_.at(id); }
  /// Covariance of all parameters for which set() was called, in the order of ParameterId. Exactly
  /// symmetric.
  Covariance covariance() const;

 private:
  double product(const Gradient& a, const Gradient& b) const;
  std::vector<std::pair<Eigen::Index, Eigen::MatrixXd>> blocks_;
  Eigen::Index size_ = 0;
  std::map<ParameterId, Gradient> gradients_;
};

}  // namespace awmr
