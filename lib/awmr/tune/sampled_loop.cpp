#include "awmr/tune/sampled_loop.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/MatrixFunctions>

namespace awmr {
namespace {

/// z -> zeta of its continuous equal s = ln(z)/T_s.
double damping_of(const std::complex<double>& z) {
  if (std::abs(z) < 1e-12) return 1.0;  // gone within the sample
  const std::complex<double> s = std::log(z);
  const double magnitude = std::abs(s);
  return magnitude > 0.0 ? -s.real() / magnitude : 0.0;
}

}  // namespace

double damping_ratio(const SampledHeadingLoop& loop) {
  // [Phi Gamma; 0 1] = exp([A B; 0 0] T_s), states psi, r, w_lag and the held input w.
  Eigen::Matrix4d continuous = Eigen::Matrix4d::Zero();
  continuous(0, 1) = 1.0;
  continuous(1, 1) = -loop.resistance_rate;
  continuous(1, 2) = 1.0 - loop.direct_share;
  continuous(1, 3) = loop.direct_share;
  continuous(2, 2) = -1.0 / loop.servo_time_constant_s;
  continuous(2, 3) = 1.0 / loop.servo_time_constant_s;
  const Eigen::Matrix4d discrete = (continuous * loop.sample_time_s).exp();

  const Eigen::RowVector3d law(-loop.lambda * loop.reaching_rate,
                               loop.resistance_rate - loop.lambda - loop.reaching_rate, 0.0);
  const Eigen::Matrix3d closed =
      discrete.topLeftCorner<3, 3>() + discrete.topRightCorner<3, 1>() * law;
  const Eigen::Vector3cd eigenvalues =
      Eigen::EigenSolver<Eigen::Matrix3d>(closed, false).eigenvalues();
  return std::min(
      {damping_of(eigenvalues(0)), damping_of(eigenvalues(1)), damping_of(eigenvalues(2))});
}

}  // namespace awmr
