/// Damping ratio and delay margin of the sampled heading loop, with zero-order hold, servo and
/// motor lag. Private to tune/.
#pragma once

namespace awmr {

/// Heading loop linearised at one yaw rate r0, with the sliding variable S inside the boundary
/// layer. psi is the deviation from the commanded heading, and w the commanded yaw acceleration
/// tau_turn/I'z. The difference of left and right wheel forces makes the share s of the yaw moment:
///
///     psi_dot = r
///     r_dot   = -a r + q (s w_motor + (1 - s) w_servo)  a = g3'(r0)/I'z, the plant's own damping
///     w_servo_dot = (w - w_servo)/T                     the steering servo
///     w_motor_dot = (w - w_motor)/T_m                   the motors; w_motor = w where T_m = 0
///     w = c r_j - (lambda + k) r_j - lambda k psi_j     the law, k = mu/eps, held over T_s;
///                                                       r_j, psi_j: the latest readings
///
/// The heading law uses the parameters of the model, which can differ from those of the plant: c is
/// g3'(r0)/I'z of the model, and q is the model's I'z divided by the plant's. If the plant is that
/// of the model, c = a and q = 1.
///
/// With an observer of bandwidth L (control/disturbance_observer.h), the law subtracts the
/// estimated disturbance d_hat = I'z (y + L r), y the state of the observer:
///
///     w       = c r_j - (lambda + k + L) r_j - lambda k psi_j - y_j
///     y_(j+1) = y_j + T_s L ((lambda + k) r_j + lambda k psi_j)
///
/// Without hold and servo, and with c = a and q = 1, the poles are -lambda, -k and, with an
/// observer, -L. Hold and servo delay the cancellation of a by c by about tau = T + T_s/2. The
/// remaining term a r - a r(t - tau), about a tau r_dot, multiplies the inertia by 1 + a tau. The
/// delay also reduces the phase: for lambda k << (lambda + k)/tau, a damping ratio zeta requires
/// about (lambda + k) tau <= 1/(4 zeta^2). The functions below use the exact discretisation.
struct SampledHeadingLoop {
  double lambda = 0.0;                 ///< 1/s
  double reaching_rate = 0.0;          ///< k = mu/eps, 1/s
  double resistance_rate = 0.0;        ///< a, 1/s
  double fed_forward_rate = 0.0;       ///< c, 1/s
  double input_gain = 1.0;             ///< q, > 0: I'z of the model divided by that of the plant
  double servo_time_constant_s = 0.0;  ///< T, > 0
  double sample_time_s = 0.0;          ///< T_s, > 0
  double direct_share = 0.0;  ///< s: 1 in differential mode, 0 in steering, 1/2 in combined
  double motor_time_constant_s = 0.0;  ///< T_m, >= 0
  double observer_radps = 0.0;         ///< L, >= 0, L T_s < 1; 0: no observer
  /// Delay of the held command before motors and servo, s, >= 0; need not be a multiple of T_s. A
  /// delay of the readings has the same effect as an equal delay of the command.
  double command_delay_s = 0.0;
};

/// A sampled pole z with |z| below this value decays by a factor of 10 or more in one sample, so
/// damping_ratio() counts it with the damping ratio 1.
inline constexpr double kGoneWithinASample = 0.1;
/// Smallest damping ratio zeta = -Re(s)/|s| over the poles s = ln(z)/T_s of the closed loop. z are
/// the eigenvalues of its matrix from one sample to the next. In [-1, 1]; positive exactly if the
/// loop is stable (every |z| < 1). A negative z (alternating signs) counts with the angle pi.
double damping_ratio(const SampledHeadingLoop& loop);

/// Smallest damping ratio of the speed loop. Its equations are those of SampledHeadingLoop for
/// lambda = 0 and s = 1, without psi (precondition: `loop` has these values). r is the deviation
/// from the commanded speed u_d, m/s, k is mu_s/eps_s, and m' replaces I'z. a = (g1'(u_d) + n
/// k_e)/m', with the back-EMF k_e of n driven wheels. Positive exactly if the loop is stable.
double speed_damping_ratio(const SampledHeadingLoop& loop);

/// Like damping_ratio(), but poles that decay much faster than the slowest pole count less, because
/// they hardly affect the response. sigma = -Re(s) is the decay rate of a pole s, sigma_slowest
/// that of the slowest pole. The result is the smallest max(zeta, sigma/(20 sigma_slowest)) over
/// the poles. A limit of 0.25 therefore permits poles with zeta < 0.25 that decay at least five
/// times as fast as the slowest pole. A latency of many samples adds such poles. sigma_slowest is
/// computed without observer, and without the servo or motors if they do not turn the vehicle in
/// this mode.
double dominant_damping_ratio(const SampledHeadingLoop& loop);

/// Delay margin: smallest additional delay of the command, s, that makes the loop unstable. 0 if
/// the loop is already unstable, infinity if no delay makes it unstable.
///
/// With the additional delay, the loop has the whole delay D = (m + f) T_s: m whole samples, and
/// the fraction f of a sample, 0 <= f < 1. The loop has a pole z = e^(j w T_s) of the frequency w,
/// rad/s, on the unit circle exactly where
///     P(w, f) = e^(j w D),
///     P(w, f) = C(z) (z I - Phi)^-1 (Gamma0(f) + Gamma1(f)/z) e^(j w f T_s).
/// Phi, Gamma0 and Gamma1 describe the plant held over T_s (HeldPlant), and C the control law. The
/// condition |P| = 1 determines w, then the phase of P determines D. P hardly depends on f, so a
/// fixed-point iteration over f converges.
double delay_margin_s(const SampledHeadingLoop& loop);

}  // namespace awmr
