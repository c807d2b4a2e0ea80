#include "awmr/tune/sampled_loop.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/MatrixFunctions>

#include "awmr/core/linear_algebra.h"

namespace awmr {
namespace {

/// z -> zeta of its continuous equal s = ln(z)/T_s.
double damping_of(const std::complex<double>& z) {
  if (std::abs(z) < kGoneWithinASample) return 1.0;
  const std::complex<double> s = std::log(z);
  const double magnitude = std::abs(s);
  return magnitude > 0.0 ? -s.real() / magnitude : 0.0;
}

}  // namespace

double damping_ratio(const SampledHeadingLoop& loop) {
  // [Phi Gamma; 0 1] = exp([A B; 0 0] T_s), states psi, r, w_servo, w_motor and the held input w.
  using Matrix5 = Eigen::Matrix<double, 5, 5>;
  const bool lag = loop.motor_time_constant_s > 0.0;
  Matrix5 continuous = Matrix5::Zero();
  continuous(0, 1) = 1.0;
  continuous(1, 1) = -loop.resistance_rate;
  continuous(1, 2) = loop.input_gain * (1.0 - loop.direct_share);
  continuous(1, lag ? 3 : 4) = loop.input_gain * loop.direct_share;
  continuous(2, 2) = -1.0 / loop.servo_time_constant_s;
  continuous(2, 4) = 1.0 / loop.servo_time_constant_s;
  // Without a lag nothing reads w_motor: it only has to die out.
  const double motor_s = lag ? loop.motor_time_constant_s : loop.sample_time_s;
  continuous(3, 3) = -1.0 / motor_s;
  continuous(3, 4) = 1.0 / motor_s;
  const Matrix5 discrete = (continuous * loop.sample_time_s).exp();

  // The states, y of an observer, then the commands still to come: w of this sample's readings enters
  // at the last of them, or at once.
  const double k = loop.reaching_rate;
  const double l = loop.observer_radps;
  const Eigen::Index states = l > 0.0 ? 5 : 4;
  const Eigen::Index n = loop.late_samples;
  Eigen::RowVectorXd law = Eigen::RowVectorXd::Zero(states);
  law(0) = -loop.lambda * k;
  law(1) = loop.fed_forward_rate - loop.lambda - k - l;
  Eigen::MatrixXd closed = Eigen::MatrixXd::Zero(states + n, states + n);
  closed.topLeftCorner<4, 4>() = discrete.topLeftCorner<4, 4>();
  if (l > 0.0) {
    law(4) = -1.0;
    closed(4, 0) = loop.sample_time_s * l * loop.lambda * k;
    closed(4, 1) = loop.sample_time_s * l * (loop.lambda + k);
    closed(4, 4) = 1.0;
  }
  const Eigen::Vector4d by_command = discrete.topRightCorner<4, 1>();
  if (n == 0) {
    closed.topLeftCorner(4, states) += by_command * law;
  } else {
    closed.block<4, 1>(0, states) = by_command;
    for (Eigen::Index i = 0; i + 1 < n; ++i) closed(states + i, states + 1 + i) = 1.0;
    closed.block(states + n - 1, 0, 1, states) = law;
  }
  const Eigen::VectorXcd poles = eigenvalues(closed);
  double worst = 1.0;
  for (const std::complex<double>& z : poles) worst = std::min(worst, damping_of(z));
  return worst;
}

}  // namespace awmr
