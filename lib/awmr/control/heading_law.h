/// The heading law: sliding mode with a boundary layer.
#pragma once

#include "awmr/control/controller.h"
#include "awmr/control/feed_forward.h"
#include "awmr/control/flash.h"
#include "awmr/control/measurement.h"
#include "awmr/control/wrap_angle.h"

namespace awmr {

/// Sliding variable S of the heading law, rad/s:
///   S     = e_dot + lambda e
///   e     = wrap(psi_d - psi)
///   e_dot = psi_d_dot - r                                                        [paper (81)-(82)]
/// e: heading error, psi_d: desired heading, psi: heading, r: yaw rate, lambda: a gain.
template <class T>
AWMR_INLINE T sliding_surface(const T& lambda, const T& error_rate_radps, const T& error_rad) {
  return error_rate_radps + lambda * wrap_angle(error_rad);
}

/// Computes the yaw moment that the heading law commands, divided by F_max, m:
///   tau_turn = g3(r) + I'z (psi_d_ddot + lambda e_dot) + I'z mu sat(S/eps)
///   sat(z)   = z for |z| <= 1, sgn z beyond                           [paper (84)-(89), corrected]
/// g3: yaw resistance, r: yaw rate, I'z: yaw inertia divided by F_max, psi_d: desired heading, e:
/// heading error, S: sliding variable; lambda, mu, eps: gains.
///
/// Corrected: (84)-(85) print r_ddot instead of r_dot. (88)-(89) print psi_d_dot - r_dot instead of
/// psi_d_dot - r. (87) and (78) print the condition |e| <= eps of sat instead of |S| <= eps. The
/// printed law also subtracts the disturbance. It is omitted here because it is unknown; mu must be
/// large enough to dominate it.
template <class T, class G>
AWMR_INLINE T heading_law(const PreparedController<T, G>& c, const Measurement<T>& m,
                          const Reference<T>& ref) {
  const LawConstants<T>& k = c.constants.laws;
  const T error_rate = math::difference(ref.psi_rate_radps, m.r_radps);
  const T s = sliding_surface(k.lambda, error_rate, T(ref.psi_rad - m.psi_rad));
  const T correction = math::saturate(T(k.heading_slope * s), k.heading_limit);
  const T held = fed_forward(c.yaw, m.r_radps, s) + (k.heading_rate * error_rate + correction);
  return math::plus_product(held, c.constants.inertia_norm, ref.psi_accel_radps2);
}

}  // namespace awmr
