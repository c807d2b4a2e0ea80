/// Integration with exact Coulomb friction: a vehicle can stop, be held at rest, and start again.
/// Templates on the scalar.
///
/// At rest, the surge resistance g1 jumps from -c to c, the Coulomb friction. During an integration
/// step, the friction keeps the direction s of the motion, 1 or -1. With the surge force X of the
/// wheels,
///   u_dot = (X - s c - (g1(u) - c sgn u))/m' + r v
/// An integration step in which the speed u passes 0 is cut at the time at which u is 0. Then
/// friction holds the vehicle (u_dot = 0) as long as the driving force |X + m' r v| is at most c.
/// Yaw is treated in the same way. If a chord (rest.h) replaced the jump, a vehicle that friction
/// should hold would creep.
#pragma once

#include "awmr/model/rest.h"
#include "awmr/model/runge_kutta.h"

namespace awmr {

/// Decelerations by Coulomb friction: c divided by the inertia.
template <class T>
struct FrictionRates {
  T surge_mps2;  ///< c1/m', m/s^2, >= 0
  T yaw_radps2;  ///< c3/I'z, rad/s^2, >= 0
  bool any() const { return value_of(surge_mps2) > 0.0 || value_of(yaw_radps2) > 0.0; }
};

template <class T>
FrictionRates<T> friction_rates(const Plant<T>& plant) {
  return {T(plant.surge.coulomb / plant.mass_norm), T(plant.yaw.coulomb / plant.inertia_norm)};
}

template <class T>
Plant<T> without_friction(Plant<T> plant) {
  plant.surge.coulomb = T(0.0);
  plant.yaw.coulomb = T(0.0);
  return plant;
}

/// As resolved_at_rest(), for integration with exact Coulomb friction c: the chords are computed
/// from the resistances without c.
template <class T>
Plant<T> resolved_beside_friction(Plant<T> plant, double step_s) {
  const Plant<T> resolved = resolved_at_rest(without_friction(plant), step_s);
  plant.surge.rest_speed = resolved.surge.rest_speed;
  plant.yaw.rest_speed = resolved.yaw.rest_speed;
  return plant;
}

/// Sliding directions of surge and yaw: 1 (forward, counter-clockwise), -1 (opposite), or 0 if
/// friction holds the motion or there is no friction.
struct Sliding {
  double surge = 0.0;
  double yaw = 0.0;
};

/// Direction of sliding: the sign of `speed`. At rest, it is the sign of the acceleration `rate`
/// without friction, or 0 if |rate| <= friction, the deceleration by friction.
inline double slides(double speed, double rate, double friction) {
  if (!(friction > 0.0)) return 0.0;
  if (speed > 0.0) return 1.0;
  if (speed < 0.0) return -1.0;
  return rate > friction ? 1.0 : rate < -friction ? -1.0 : 0.0;
}

/// Directions of sliding in the state s. `rates`: the rates of this state without friction.
template <class T>
Sliding sliding(const FrictionRates<T>& friction, const State<T>& s, const State<T>& rates) {
  return {slides(value_of(s.u_mps), value_of(rates.u_mps), value_of(friction.surge_mps2)),
          slides(value_of(s.r_radps), value_of(rates.r_radps), value_of(friction.yaw_radps2))};
}

/// True if friction holds a motion (surge or yaw) at rest: there is friction, and the sliding
/// direction `way` is 0.
inline bool is_held(double way, double friction) { return friction > 0.0 && way == 0.0; }

/// Adds friction in the directions `way` to `rates` without friction. The acceleration of a motion
/// that friction holds becomes 0.
template <class T>
State<T> with_friction(const FrictionRates<T>& friction, const Sliding& way, State<T> rates) {
  rates.u_mps = is_held(way.surge, value_of(friction.surge_mps2))
                    ? T(0.0)
                    : T(rates.u_mps - way.surge * friction.surge_mps2);
  rates.r_radps = is_held(way.yaw, value_of(friction.yaw_radps2))
                      ? T(0.0)
                      : T(rates.r_radps - way.yaw * friction.yaw_radps2);
  return rates;
}

/// Fraction of a step after which the speed is 0, if it changes linearly from `from` to `to`.
/// Returns 1 if the speed does not pass 0, or starts at 0. `way`: direction of sliding in this
/// step.
inline double share_until_rest(double way, double from, double to) {
  if (!(way * from > 0.0) || !(way * to < 0.0)) return 1.0;
  return from / (from - to);
}

/// Maximum number of stops at which a step is cut. After them, the rest of the step is not cut
/// again.
inline constexpr int kMaxStopsInAStep = 4;

/// One Runge-Kutta step, rk4_step(), with Coulomb friction: the state h seconds after s.
/// `rates(state)`: the rates without friction.
template <class T, class Rates>
State<T> rk4_step_with_friction(const FrictionRates<T>& friction, State<T> s, T h,
                                const Rates& rates) {
  if (!friction.any()) return rk4_step(s, h, rates);
  for (int stops = 0;; ++stops) {
    const Sliding way = sliding(friction, s, rates(s));
    const auto slid = [&](const State<T>& at) { return with_friction(friction, way, rates(at)); };
    const State<T> next = rk4_step(s, h, slid);
    const double surge = share_until_rest(way.surge, value_of(s.u_mps), value_of(next.u_mps));
    const double yaw = share_until_rest(way.yaw, value_of(s.r_radps), value_of(next.r_radps));
    if ((surge == 1.0 && yaw == 1.0) || stops == kMaxStopsInAStep) return next;
    const bool surge_stops = surge <= yaw;
    const T share = surge_stops ? T(s.u_mps / (s.u_mps - next.u_mps))
                                : T(s.r_radps / (s.r_radps - next.r_radps));
    s = rk4_step(s, T(share * h), slid);
    (surge_stops ? s.u_mps : s.r_radps) = T(0.0);
    h = T((T(1.0) - share) * h);
  }
}

}  // namespace awmr
