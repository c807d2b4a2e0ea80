/// The heading loop as it really runs: sampled, its command held, part of it through the servo.
/// Private to tune/.
#pragma once

namespace awmr {

/// Linear, inside the boundary layer and at one yaw rate r0, for small psi about the command:
///
///     psi_dot = r
///     r_dot   = -a r + q (s w_motor + (1 - s) w_servo)  a = g3'(r0)/I'z, the plant's own damping
///     w_servo_dot = (w - w_servo)/T                     the steering servo
///     w_motor_dot = (w - w_motor)/T_m                   the motors; w_motor = w where T_m = 0
///     w = c r_j - (lambda + k) r_j - lambda k psi_j     the law, k = mu/eps, held over T_s,
///                                                       from the readings of j = n samples ago
///
/// The law knows the model alone: c is the g3'(r0)/I'z of the model, and q the I'z of the model
/// over the plant's. For the model's own plant c = a and q = 1.
///
/// With an observer of bandwidth L (control/disturbance_observer.h), d_hat = I'z (y + L r) is taken
/// off:
///
///     w       = c r_j - (lambda + k + L) r_j - lambda k psi_j - y_j
///     y_(j+1) = y_j + T_s L ((lambda + k) r_j + lambda k psi_j)
///
/// Without hold and servo, with the model's own plant, a cancels and
/// s^2 + (lambda + k) s + lambda k has the roots -lambda, -k, and the observer adds -L.
/// With them the cancellation comes late: a r - a r(t - tau) is about a tau r_dot, an added inertia
/// of 1 + a tau, and the product (lambda + k) tau takes phase, tau = T + T_s/2. To first order and
/// with lambda k << (lambda + k)/tau, damping zeta needs (lambda + k) tau <= 1/(4 zeta^2); here the
/// exact discretisation is used instead.
struct SampledHeadingLoop {
  double lambda = 0.0;                 ///< 1/s
  double reaching_rate = 0.0;          ///< k = mu/eps, 1/s
  double resistance_rate = 0.0;        ///< a, 1/s
  double fed_forward_rate = 0.0;       ///< c, 1/s
  double input_gain = 1.0;             ///< q, > 0
  double servo_time_constant_s = 0.0;  ///< T, > 0
  double sample_time_s = 0.0;          ///< T_s, > 0
  double direct_share = 0.0;           ///< s: 1 differential, 0 steering, 1/2 combined
  double motor_time_constant_s = 0.0;  ///< T_m, >= 0
  double observer_radps = 0.0;         ///< L, >= 0, L T_s < 1; 0: no observer
  int late_samples = 0;                ///< n, 0 ... 1000: latency of the readings in samples
  /// Delay of the held command on its way to motors and servo, s, >= 0: any part of T_s. A delay of as
  /// much of the readings gives the same loop.
  double command_delay_s = 0.0;
};

/// Smallest damping ratio zeta = -Re(s)/|s|, s = ln(z)/T_s, over the eigenvalues z of the closed
/// loop from one sample to the next. In [-1, 1]; positive exactly when every |z| < 1; a ringing z <
/// 0 counts with its angle pi. A mode of which less than kGoneWithinASample is left after a sample
/// does not ring: it counts as 1.
inline constexpr double kGoneWithinASample = 0.1;
double damping_ratio(const SampledHeadingLoop& loop);

/// The least further delay of the command, s, with which the loop is no longer stable: 0 if it is not
/// stable as it is, infinity if no delay makes it so.
///
/// With the delay D = (n + m + f) T_s, m whole and 0 <= f < 1, the loop has a pole z = e^(j w T_s) on the unit
/// circle exactly where
///     P(w, f) = e^(j w D),   P(w, f) = C(z) (z I - Phi)^-1 (Gamma0(f) + Gamma1(f)/z) e^(j w f T_s),
/// Phi, Gamma the plant held over T_s, C the law. |P| = 1 gives w, the phase D. P hardly depends on f, so
/// that D follows by fixed-point iteration from the f before.
double delay_margin_s(const SampledHeadingLoop& loop);

}  // namespace awmr
