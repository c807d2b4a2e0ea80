#include "awmr/identify/uncertainty/joint_covariance.h"

namespace awmr {

Eigen::Index JointCovariance::add_block(const Eigen::MatrixXd& covariance) {
  const Eigen::Index first = size_;
  blocks_.emplace_back(first, covariance);
  size_ += covariance.rows();
  return first;
}

double JointCovariance::product(const Gradient& a, const Gradient& b) const {
  double sum = 0.0;
  for (const auto& [first, block] : blocks_) {
    for (const auto& [i, a_i] : a) {
      if (i < first || i >= first + block.rows()) continue;
      for (const auto& [j, b_j] : b) {
        if (j < first || j >= first + block.rows()) continue;
        sum += a_i * block(i - first, j - first) * b_j;
      }
    }
  }
  return sum;
}

double JointCovariance::variance(const Gradient& gradient) const {
  return product(gradient, gradient);
}

Covariance JointCovariance::covariance() const {
  Covariance covariance;
  for (const auto& [id, gradient] : gradients_) {
    covariance.parameters.push_back(id);
    std::vector<double>& row = covariance.matrix.emplace_back();
    for (const auto& [other, other_gradient] : gradients_) {
      row.push_back(0.5 * (product(gradient, other_gradient) + product(other_gradient, gradient)));
    }
  }
  return covariance;
}

}  // namespace awmr
