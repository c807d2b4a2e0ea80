/// Resistance to motion: one odd curve whose special cases are the families. Freestanding C++14.
#pragma once

#include "awmr/model/scalar_math.h"

namespace awmr {

/// g(w) = (c + alpha |w|^beta + q w^2) sgn w            [paper (47), (63) with c = q = 0; odd
/// extension]
///
/// Surge: w = u in m/s, g1 dimensionless (force over F_max). Yaw: w = r in rad/s, g3 in m (moment
/// over F_max). alpha > 0 in the unit of g per unit of w^beta; beta >= 0, in [0, 1] for surge in
/// the paper; c >= 0 (Coulomb) in the unit of g; q >= 0 in the unit of g per unit of w^2.
///
/// For beta < 1 the slope at rest is infinite, for c > 0 the curve jumps there. A simulation of
/// step h cannot follow time constants below h, so below `rest_speed` the curve is its chord to the
/// origin; 0 keeps the law exact (simulate/ states how it chooses the value).
template <class T>
struct Resistance {
  T alpha;
  T beta;
  T rest_speed = T(0.0);
  T coulomb = T(0.0);
  T quadratic = T(0.0);

  /// g at |w| = magnitude > 0, without chord or sign.
  T at(const T& magnitude) const {
    using math::pow;
    return coulomb + alpha * pow(magnitude, beta) + quadratic * magnitude * magnitude;
  }

  T operator()(const T& speed) const {
    using math::abs;
    const T magnitude = abs(speed);
    if (!(magnitude > T(0.0))) return T(0.0);
    if (magnitude < rest_speed) return at(rest_speed) / rest_speed * speed;
    return speed > T(0.0) ? at(magnitude) : -at(magnitude);
  }
};

/// The law as a controller feeds it forward. A curve that jumps at rest would make the command chatter
/// between +c and -c there, so below this speed (m/s, rad/s) it is its chord.
template <class T>
constexpr T feed_forward_rest_speed() {
  return T(0.02);
}
template <class T>
Resistance<T> feed_forward(Resistance<T> law) {
  if (law.coulomb > T(0.0)) law.rest_speed = feed_forward_rest_speed<T>();
  return law;
}

/// The command that leaves `force` beyond a motor's dead zone; 0 for 0.
template <class T>
T with_dead_zone(const T& force, const T& zone) {
  if (force > T(0.0)) return force + zone;
  if (force < T(0.0)) return force - zone;
  return force;
}

/// What is left of a command after a motor's dead zone, >= 0: it does nothing up to `zone` and
/// loses that much beyond.
template <class T>
T beyond_dead_zone(const T& command, const T& zone) {
  if (command > zone) return command - zone;
  if (command < -zone) return command + zone;
  return T(0.0);
}

}  // namespace awmr
