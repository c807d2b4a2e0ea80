/// Resistance to motion as an odd function of the speed. The families of family.h are special cases
/// of this law. Freestanding C++14.
#pragma once

#include "awmr/model/scalar_math.h"

namespace awmr {

/// The force or moment g that resists the speed or yaw rate w. It has the sign of w and acts
/// against the motion:
///   g(w) = (c + alpha |w|^beta + q w^2) sgn w                                   [paper (47), (63)]
/// The paper has c = q = 0 and only w > 0; its law is extended here to an odd curve.
///
/// Surge: g1 of w = u in m/s, dimensionless (a force divided by F_max). Yaw: g3 of w = r in rad/s,
/// in m (a moment divided by F_max). The family determines which of c, beta and q a fit estimates
/// (family.h).
template <class T>
struct Resistance {
  /// alpha, > 0: resistance at unit speed for c = q = 0. Surge: a1, (s/m)^b1; yaw: a3, m
  /// (s/rad)^b3. Fitted to steady runs or logs.
  T alpha;
  /// beta, dimensionless, >= 0: exponent of the speed. Surge: b1, in [0, 1] in the paper; yaw: b3.
  /// Below 1 the slope at rest is infinite.
  T beta;
  /// Speed, m/s or rad/s, >= 0, below which a straight line through the origin (chord) replaces
  /// g(w) and meets the curve at this speed. 0 keeps the law exact, for fits and steady states. A
  /// simulation needs a chord, because at rest the curve jumps for c > 0 and has an infinite slope
  /// for beta < 1. rest_speed() in steady.h computes this speed from the length of the steps.
  T rest_speed = T(0.0);
  /// c, in the unit of g, >= 0: Coulomb friction, the same at every speed. 0 in the paper.
  T coulomb = T(0.0);
  /// q, >= 0: quadratic part. Surge: q1, s^2/m^2; yaw: q3, m s^2/rad^2. 0 in the paper.
  T quadratic = T(0.0);

  /// g(magnitude) for a magnitude > 0, without the chord.
  T at(const T& magnitude) const {
    using math::pow;
    return coulomb + alpha * pow(magnitude, beta) + quadratic * magnitude * magnitude;
  }

  /// g(speed) with sign and chord, for any speed; 0 at 0.
  T operator()(const T& speed) const {
    using math::abs;
    using math::any;
    using math::larger;
    using math::select;
    const T magnitude = abs(speed);
    if (!MaskOf<T>::kOneLane) {
      // In a batch, each lane is one vehicle, and lanes cannot branch differently, so this code has
      // no branches. The quotient 1/chord is the same in every step, so the compiler can compute it
      // once for several calls.
      const T chord = larger(rest_speed, T(1e-30));
      const T sign = select(speed < T(0.0), T(-1.0), T(1.0));
      const T share = select(magnitude < chord, T(speed * (T(1.0) / chord)), sign);
      return at(larger(magnitude, chord)) * share;
    }
    if (!any(magnitude > T(0.0))) return T(0.0);
    if (any(magnitude < rest_speed)) return at(rest_speed) / rest_speed * speed;
    const T resists = at(magnitude);
    return select(speed > T(0.0), resists, T(-resists));
  }
};

/// Default speed (m/s) or yaw rate (rad/s) below which a controller replaces a resistance with
/// Coulomb friction c by its chord, a straight line through the origin. The curve itself jumps from
/// -c to c at rest, which would make the command chatter.
template <class T>
constexpr T feed_forward_rest_speed() {
  return T(0.02);
}
/// The law that a controller feeds forward: `law`, and if this has Coulomb friction, with a chord
/// below the speed `rest_speed`.
template <class T>
Resistance<T> feed_forward(Resistance<T> law, const T& rest_speed = feed_forward_rest_speed<T>()) {
  if (law.coulomb > T(0.0)) law.rest_speed = rest_speed;
  return law;
}

/// The command with which a motor with a dead zone makes `force`; 0 for the force 0. Command and
/// force are divided by F_max; zone = F'0 >= 0. Inverse of beyond_dead_zone() for every force
/// except 0.
template <class T>
T with_dead_zone(const T& force, const T& zone) {
  using math::select;
  return select(force > T(0.0), T(force + zone), select(force < T(0.0), T(force - zone), force));
}

/// The force that a motor with a dead zone makes for `command`: 0 for |command| <= zone; for a
/// larger |command|, the command with its magnitude reduced by the zone. Command and force are
/// divided by F_max; zone = F'0 >= 0.
template <class T>
T beyond_dead_zone(const T& command, const T& zone) {
  using math::select;
  return select(command > zone, T(command - zone),
                select(command < -zone, T(command + zone), T(0.0)));
}

}  // namespace awmr
