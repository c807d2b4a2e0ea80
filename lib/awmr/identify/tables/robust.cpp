#include "awmr/identify/tables/robust.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {

std::unique_ptr<ceres::LossFunction> make_loss(Loss loss, double scale) {
  switch (loss) {
    case Loss::kSquared:
      return nullptr;
    case Loss::kHuber:
      return std::make_unique<ceres::HuberLoss>(1.345 * scale);
    case Loss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(2.385 * scale);
    case Loss::kTukey:
      return std::make_unique<ceres::TukeyLoss>(4.685 * scale);
  }
  return nullptr;
}

double median_scale(const Eigen::VectorXd& residuals) {
  std::vector<double> sizes(at(residuals.size()));
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::abs(residuals(eigen_index(i)));
  return kStdPerMad * quantile(std::move(sizes), 0.5);
}

double m_estimate_variance(const ceres::LossFunction& loss, const Eigen::VectorXd& residuals,
                           int parameters) {
  const auto n = static_cast<double>(residuals.size());
  double squares = 0.0;
  double jacobian_sum = 0.0;
  double jacobian_squares = 0.0;
  for (const double e : residuals) {
    // The loss rho and its first two derivatives with respect to its argument, at e^2. The cost of
    // a residual e is rho(e^2)/2, so its first and second derivatives with respect to e are psi = e
    // rho' and psi' = rho' + 2 e^2 rho''.
    double rho[3];
    loss.Evaluate(e * e, rho);
    const double psi = e * rho[1];
    const double jacobian = rho[1] + 2.0 * e * e * rho[2];
    squares += psi * psi;
    jacobian_sum += jacobian;
    jacobian_squares += jacobian * jacobian;
  }
  const double mean = jacobian_sum / n;
  const double variance = std::max(0.0, jacobian_squares / n - mean * mean);
  const double kappa = 1.0 + parameters / n * variance / (mean * mean);
  return kappa * kappa * squares / (n - parameters) / (mean * mean);
}

}  // namespace awmr
