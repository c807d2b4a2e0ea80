/// LQI (linear-quadratic with integral) heading law, a baseline for comparison with the sliding
/// mode of heading_law.h.
#pragma once

#include "awmr/control/allocation_limits.h"
#include "awmr/control/feed_forward.h"
#include "awmr/control/measurement.h"
#include "awmr/control/wrap_angle.h"
#include "awmr/model/dynamics.h"

namespace awmr {

/// Weights of the quadratic cost. Each weight is given as the largest acceptable value of a
/// quantity (Bryson's rule).
template <class T>
struct LqiWeights {
  T heading_rad;     ///< e_max, rad, > 0: largest heading error e
  T yaw_rate_radps;  ///< r_max, rad/s, > 0: largest rate e_dot of the error
  T integral_rad_s;  ///< z_max, rad s, > 0: largest integral z of the error
  /// tau_max, m, > 0: largest yaw moment, divided by F_max, that the law adds to the moments for
  /// the yaw resistance and for the acceleration of the reference.
  T tau_turn_m;
};

/// Gains of the LQI law: w = a1 e + a2 e_dot + a0 z is the commanded yaw acceleration for the
/// heading error e, its rate e_dot and its integral z.
template <class T>
struct LqiGains {
  T integral_per_s3;  ///< a0, 1/s^3
  T heading_per_s2;   ///< a1, 1/s^2
  T rate_per_s;       ///< a2, 1/s
};

/// Computes the gains that minimise
///   J = integral of (e/e_max)^2 + (e_dot/r_max)^2 + (z/z_max)^2 + (w/w_max)^2,
///   w_max = tau_max/I'z
/// for the heading error e, its integral z and the commanded yaw acceleration w. The law tau_turn =
/// g3(r) + I'z (psi_d_ddot + w) feeds the yaw resistance g3 forward, so the plant for w is linear
/// at every yaw rate:
///   z_dot = e,  e_ddot = -w
/// The optimal law is w = a1 e + a2 e_dot + a0 z. In general, its gains require the stabilising
/// solution of an algebraic Riccati equation. For this chain of integrators, they follow by
/// spectral factorisation (Kalman, When is a linear control system optimal?, 1964): the polynomial
/// p(s) = s^3 + a2 s^2 + a1 s + a0 is the stable factor of
///   p(s) p(-s) = -s^6 + w_max^2 (s^4/r_max^2 - s^2/e_max^2 + 1/z_max^2)
/// Comparing powers of s gives
///   a0   = w_max/z_max
///   a2^2 = w_max^2/r_max^2 + 2 a1
///   a1^2 = w_max^2/e_max^2 + 2 a0 a2
/// The last two lines give one equation for a1. Its left side minus its right side is convex, and
/// below 0 at a1 = 0, so there is one positive root. Newton's method converges to this root
/// monotonically from any larger value. The initial value is larger than the root and less than
/// three times as large, because
///   a1^2 <= c1 + 2 a0 sqrt(c2) + 2 a0 sqrt(2 a1),  c1 = w_max^2/e_max^2,  c2 = w_max^2/r_max^2
template <class T>
LqiGains<T> lqi_gains(const LqiWeights<T>& weights, const T& inertia_norm) {
  using math::pow;
  using math::sqrt;
  const T w_max = weights.tau_turn_m / inertia_norm;
  const T a0 = w_max / weights.integral_rad_s;
  const T c1 = w_max / weights.heading_rad * (w_max / weights.heading_rad);
  const T c2 = w_max / weights.yaw_rate_radps * (w_max / weights.yaw_rate_radps);
  T a1 = sqrt(c1) + sqrt(T(2.0) * a0 * sqrt(c2)) + pow(T(8.0) * a0 * a0, T(1.0 / 3.0));
  for (bool falls = true; falls;) {
    const T a2 = sqrt(c2 + T(2.0) * a1);
    const T next = a1 - (a1 * a1 - c1 - T(2.0) * a0 * a2) / (T(2.0) * (a1 - a0 / a2));
    falls = next < a1;
    if (falls) a1 = next;
  }
  return {a0, a1, sqrt(c2 + T(2.0) * a1)};
}

/// True if the closed loop, sampled with T_s = sample_time_s > 0, is stable. The commanded yaw
/// acceleration w = a1 e + a2 e_dot + a0 z is constant over a sample. With + for the value at the
/// next sample, the loop is
///   e+ = e + T_s e_dot - w T_s^2/2,  e_dot+ = e_dot - w T_s,  z+ = z + T_s e
/// Its characteristic polynomial in l = (eigenvalue) - 1 is
///   l^3 + A l^2 + B l + C,  A = a2 T_s + a1 T_s^2/2,  B = a1 T_s^2 + a0 T_s^3/2,  C = a0 T_s^3
/// The bilinear transformation l = 2 s/(1 - s) gives the polynomial
///   (8 - 4 A + 2 B - C) s^3 + (4 A - 4 B + 3 C) s^2 + (2 B - 3 C) s + C
/// The loop is stable if all zeros s are in the left half-plane, which Hurwitz's criterion tests.
template <class T>
bool settles_when_sampled(const LqiGains<T>& gains, const T& sample_time_s) {
  const T a = gains.rate_per_s * sample_time_s +
              gains.heading_per_s2 * sample_time_s * sample_time_s / T(2.0);
  const T c = gains.integral_per_s3 * sample_time_s * sample_time_s * sample_time_s;
  const T b = gains.heading_per_s2 * sample_time_s * sample_time_s + c / T(2.0);
  const T s3 = T(8.0) - T(4.0) * a + T(2.0) * b - c;
  const T s2 = T(4.0) * a - T(4.0) * b + T(3.0) * c;
  const T s1 = T(2.0) * b - T(3.0) * c;
  return s3 > T(0.0) && s2 > T(0.0) && s1 > T(0.0) && c > T(0.0) && s2 * s1 > s3 * c;
}

/// State of the law between samples.
template <class T>
struct LqiState {
  T integral_rad_s;  ///< z, rad s
  T error_rad;       ///< e of the current sample, rad
};

/// Computes the yaw moment that the LQI law commands, divided by F_max, m:
///   tau_turn = g3(r) + I'z (psi_d_ddot + a1 e + a2 e_dot + a0 z)
///   e        = wrap(psi_d - psi),  e_dot = psi_d_dot - r
/// `yaw` is the yaw resistance g3, of type G as in Controller; `inertia_norm` is I'z. Stores the
/// heading error e in `state`, for integrate_error().
template <class T, class G>
T lqi_law(const G& yaw, const T& inertia_norm, const LqiGains<T>& gains, const Measurement<T>& m,
          const Reference<T>& ref, LqiState<T>& state) {
  state.error_rad = wrap_angle(T(ref.psi_rad - m.psi_rad));
  const T error_rate = ref.psi_rate_radps - m.r_radps;
  const T w = gains.heading_per_s2 * state.error_rad + gains.rate_per_s * error_rate +
              gains.integral_per_s3 * state.integral_rad_s;
  return fed_forward(yaw, m.r_radps, T(w / gains.rate_per_s)) +
         inertia_norm * (ref.psi_accel_radps2 + w);
}

/// Two moments count as equal if they differ by at most this fraction, which covers rounding.
template <class T>
constexpr T same_moment_share() {
  return T(1e-6);
}

/// Advances the integral z of the heading error e by one sample:
///   z_dot = e
///   z_dot = 0 while a limit reduces the moment and e requires a larger moment
/// The second line prevents windup at a limit (conditional integration). `requested_m`: moment that
/// the law requested; `a`: its allocation; `made`: forces that the allocation makes.
template <class T>
void integrate_error(const T& requested_m, const Allocation<T>& a, const GeneralisedForces<T>& made,
                     const T& sample_time_s, LqiState<T>& state) {
  using math::abs;
  using math::select;
  const T missing_m = requested_m - (made.tau_steering_m + made.tau_diff_m);
  const Mask<T> limited = a.force_limited || a.steering_limited || a.steering_powerless;
  const Mask<T> asks_for_more =
      missing_m * state.error_rad > same_moment_share<T>() * abs(T(requested_m * state.error_rad));
  state.integral_rad_s +=
      select(limited && asks_for_more, T(0.0), T(sample_time_s * state.error_rad));
}

}  // namespace awmr
