/// One covariance over everything identified, from independent pieces of evidence. Private to
/// identify/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// Fitted parameters and derived ones are functions of independent blocks (the surge fit, the yaw
/// fit, a timing error, ...): C = G B G^T with B the blocks on the diagonal and G the gradients.
class JointCovariance {
 public:
  /// The derivatives of a parameter by the elements of the blocks; absent ones are 0.
  using Gradient = std::map<Eigen::Index, double>;

  /// Puts a block after those before it and returns the place of its first element.
  Eigen::Index add_block(const Eigen::MatrixXd& covariance);
  /// Sets the dependence of a parameter on the blocks; replaces an earlier one.
  void set(ParameterId id, Gradient gradient) { gradients_[id] = std::move(gradient); }
  bool has(ParameterId id) const { return gradients_.contains(id); }
  double variance(const Gradient& gradient) const;
  const Gradient& gradient(ParameterId id) const { return gradients_.at(id); }
  /// Over the parameters set, in the order of ParameterId; symmetric to the last bit.
  Covariance covariance() const;

 private:
  double product(const Gradient& a, const Gradient& b) const;
  std::vector<std::pair<Eigen::Index, Eigen::MatrixXd>> blocks_;
  Eigen::Index size_ = 0;
  std::map<ParameterId, Gradient> gradients_;
};

}  // namespace awmr
