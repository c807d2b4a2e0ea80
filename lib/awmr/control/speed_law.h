/// Speed law: computes the surge force from the speed error, with the resistance fed forward.
#pragma once

#include "awmr/control/controller.h"
#include "awmr/control/feed_forward.h"
#include "awmr/control/flash.h"
#include "awmr/control/measurement.h"

namespace awmr {

/// Limit of the speed whose resistance the speed law feeds forward, m/s: max(0, u_d + eps_s) if the
/// vehicle moves forward, else min(0, u_d - eps_s). u_d: desired speed, eps_s: boundary layer. It
/// applies only to a vehicle that is faster than this limit.
template <class T>
AWMR_CALLED T fastest_fed_forward(const T& u_mps, const T& u_d_mps, const T& epsilon_mps) {
  using math::select;
  return select(u_mps > T(0.0), math::larger(T(u_d_mps + epsilon_mps), T(0.0)),
                T(-math::larger(T(epsilon_mps - u_d_mps), T(0.0))));
}

/// Returns u, but fastest_fed_forward() if the vehicle is faster, m/s. `error_mps`: e_u = u_d - u;
/// `wanted`: correction m' mu_s e_u/eps_s before saturation; `limit`: its largest magnitude, m'
/// mu_s; `slope`: m' mu_s/eps_s.
template <class T>
AWMR_INLINE T at_most_fastest(const T& u_mps, const T& u_d_mps, const T& error_mps, const T& wanted,
                              const T& limit, const T& slope) {
  using math::any;
  using math::select;
  T w_mps = u_mps;
  const Mask<T> too_fast = math::is_opposite(u_mps, error_mps) && math::is_beyond(wanted, limit);
  if (any(too_fast)) {
    w_mps = select(too_fast, fastest_fed_forward(u_mps, u_d_mps, T(limit / slope)), w_mps);
  }
  return w_mps;
}

/// Returns the speed whose back-EMF the motor commands make up, m/s: u, but at most
/// fastest_fed_forward(). A speed sensor that reads too much would otherwise increase the motor
/// commands up to full force, and the motors of a vehicle that is too fast would not brake it.
template <class T>
AWMR_INLINE T made_up_speed(const LawConstants<T>& k, const T& u_mps, const T& u_d_mps) {
  const T error = u_d_mps - u_mps;
  return at_most_fastest(u_mps, u_d_mps, error, T(k.speed_slope * error), k.speed_limit,
                         k.speed_slope);
}

/// Returns the speed w whose resistance g1(w) the speed law feeds forward, m/s, at the speed u:
///   w = 0                     at u_d = 0
///   w = max(0, u_d + eps_s)   if the vehicle moves forward and faster than that
///   w = min(0, u_d - eps_s)   if the vehicle moves backward and faster than that
///   w = u                     else
/// u_d: desired speed; m': normalised mass; mu_s, eps_s: gains; e_u = u_d - u: speed error.
///
/// Why the second and third lines: without them, a vehicle that rolls down a slope faster than u_d
/// would get tau_speed = g1(u) - m' mu_s. At speeds with g1(u) > m' mu_s, this force accelerates
/// the vehicle further. The arguments are those of at_most_fastest().
template <class T>
AWMR_INLINE T fed_forward_speed(const T& u_mps, const Reference<T>& ref, const T& error_mps,
                                const T& wanted, const T& limit, const T& slope) {
  using math::any;
  using math::select;
  const T w_mps = at_most_fastest(u_mps, ref.speed_mps, error_mps, wanted, limit, slope);
  const Mask<T> stands = math::is_zero(ref.speed_mps);
  return any(stands) ? select(stands, T(0.0), w_mps) : w_mps;
}

/// Computes the surge force that the speed law commands, dimensionless:
///   tau_speed = g1(w) + m' (u_d_dot - r v) + m' mu_s sat(e_u/eps_s),   e_u = u_d - u
///                                                                    [paper (97)-(102), corrected]
/// g1: surge resistance, w: fed_forward_speed(), m': normalised mass, u_d: desired speed; u, v:
/// surge and sway speed, r: yaw rate; mu_s, eps_s: gains. Corrected: (100)-(102) are printed
/// without u_d_dot, which (99) has. The disturbance is omitted because it is unknown, as in the
/// heading law. In the paper, w is u at every speed.
template <class T, class G>
AWMR_INLINE T speed_law(const PreparedController<T, G>& c, const Measurement<T>& m,
                        const Reference<T>& ref) {
  const LawConstants<T>& k = c.constants.laws;
  const T error = ref.speed_mps - m.u_mps;
  const T wanted = k.speed_slope * error;
  const T correction = math::saturate(wanted, k.speed_limit);
  const T w_mps = fed_forward_speed(m.u_mps, ref, error, wanted, k.speed_limit, k.speed_slope);
  const T accel_mps2 = math::difference(ref.accel_mps2, T(m.r_radps * m.v_mps));
  return fed_forward(c.surge, w_mps, error) +
         math::plus_product(correction, c.constants.mass_norm, accel_mps2);
}

}  // namespace awmr
