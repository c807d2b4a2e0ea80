/// Sampled heading loop: zero-order hold of the command, part of which acts through the servo.
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
/// The law uses the parameters of the model: c is g3'(r0)/I'z of the model, and q is I'z of the
/// model over that of the plant. For the model's own plant c = a and q = 1.
///
/// With an observer of bandwidth L (control/disturbance_observer.h), d_hat = I'z (y + L r) is
/// subtracted:
///
///     w       = c r_j - (lambda + k + L) r_j - lambda k psi_j - y_j
///     y_(j+1) = y_j + T_s L ((lambda + k) r_j + lambda k psi_j)
///
/// Without hold and servo, with the model's own plant, a cancels and
/// s^2 + (lambda + k) s + lambda k has the roots -lambda, -k, and the observer adds -L.
/// Hold and servo delay the cancellation by tau = T + T_s/2: a r - a r(t - tau) is about a tau
/// r_dot, which multiplies the inertia by 1 + a tau, and (lambda + k) tau reduces the phase. To
/// first order and with lambda k << (lambda + k)/tau, damping zeta needs (lambda + k) tau <= 1/(4
/// zeta^2); here the exact discretisation is used instead.
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
  int latency_samples = 0;             ///< n, 0 ... 1000: latency of the readings in samples
  /// Delay of the held command before motors and servo, s, >= 0; need not be a multiple of T_s. The
  /// same delay of the readings gives the same loop.
  double command_delay_s = 0.0;
};

/// Smallest damping ratio zeta = -Re(s)/|s|, s = ln(z)/T_s, over the eigenvalues z of the closed
/// loop from one sample to the next. In [-1, 1]; positive exactly when every |z| < 1; z < 0
/// (alternating signs) counts with the angle pi. A mode that decays below kGoneWithinASample within
/// one sample counts as zeta = 1.
inline constexpr double kGoneWithinASample = 0.1;
double damping_ratio(const SampledHeadingLoop& loop);

/// Delay margin: smallest additional delay of the command, s, that makes the loop unstable. 0 if
/// the loop is already unstable, infinity if no delay makes it unstable.
///
/// With the delay D = (n + m + f) T_s, m whole and 0 <= f < 1, the loop has a pole z = e^(j w T_s)
/// on the unit circle exactly where
///     P(w, f) = e^(j w D),   P(w, f) = C(z) (z I - Phi)^-1 (Gamma0(f) + Gamma1(f)/z) e^(j w f T_s),
/// Phi, Gamma the plant held over T_s, C the law. |P| = 1 determines w, and the phase of P
/// determines D. P hardly depends on f, so a fixed-point iteration over f converges.
double delay_margin_s(const SampledHeadingLoop& loop);

}  // namespace awmr
