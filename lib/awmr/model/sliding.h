/// Integration with exact Coulomb friction: a vehicle can stop, be held at rest, and start again.
/// Templates on the scalar.
///
/// The surge resistance g1 has a Coulomb friction c: it jumps from -c to c at rest. During an
/// integration step, the friction keeps the direction s of the motion, 1 or -1. With the surge
/// force X of the wheels,
///   u_dot = (X - s c - (g1(u) - c sgn u))/m' + r v
/// If the speed u passes 0 in an integration step, the step is cut at the time at which u is 0.
/// Then friction holds the vehicle (u_dot = 0) as long as the driving force |X + m' r v| is at most
/// c. Yaw is treated in the same way. A chord (rest.h) instead of the jump would let a vehicle
/// creep that friction should hold.
#pragma once

#include "awmr/model/rest.h"
#include "awmr/model/runge_kutta.h"

namespace awmr {

/// The value of a number of type T, without derivatives; value_of() (rest.h) returns it.
template <class T>
using ValueOf = decltype(value_of(T()));

/// Decelerations by Coulomb friction: c divided by the inertia.
template <class T>
struct FrictionRates {
  T surge_mps2;  ///< c1/m', m/s^2, >= 0
  T yaw_radps2;  ///< c3/I'z, rad/s^2, >= 0
  bool any() const {
    using math::any;
    using Value = ValueOf<T>;
    return any(value_of(surge_mps2) > Value(0.0) || value_of(yaw_radps2) > Value(0.0));
  }
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

/// As resolved_at_rest(), for integration with exact Coulomb friction c: has the chords that the
/// resistances without c need.
template <class T>
Plant<T> resolved_beside_friction(Plant<T> plant, double step_s) {
  const Plant<T> resolved = resolved_at_rest(without_friction(plant), step_s);
  plant.surge.rest_speed = resolved.surge.rest_speed;
  plant.yaw.rest_speed = resolved.yaw.rest_speed;
  return plant;
}

/// Sliding directions of surge and yaw: 1 (forward, counter-clockwise), -1 (opposite), or 0 if
/// friction holds the motion or there is no friction.
template <class Value>
struct Sliding {
  Value surge = Value(0.0);
  Value yaw = Value(0.0);
};

/// Direction of sliding: the sign of `speed`. At rest: the sign of `rate`, the acceleration without
/// friction, or 0 if friction holds the motion, that is, if |rate| is at most the deceleration
/// `friction`.
template <class Value>
Value slides(const Value& speed, const Value& rate, const Value& friction) {
  using math::select;
  const Value zero = Value(0.0);
  const Value released =
      select(rate > friction, Value(1.0), select(rate < -friction, Value(-1.0), zero));
  const Value way = select(speed > zero, Value(1.0), select(speed < zero, Value(-1.0), released));
  return select(friction > zero, way, zero);
}

/// Directions of sliding in the state s. `rates`: the rates of this state without friction.
template <class T>
Sliding<ValueOf<T>> sliding(const FrictionRates<T>& friction, const State<T>& s,
                            const State<T>& rates) {
  return {slides(value_of(s.u_mps), value_of(rates.u_mps), value_of(friction.surge_mps2)),
          slides(value_of(s.r_radps), value_of(rates.r_radps), value_of(friction.yaw_radps2))};
}

/// True if friction holds a motion (surge or yaw) at rest: there is friction, and the sliding
/// direction `way` is 0.
template <class Value>
Mask<Value> is_held(const Value& way, const Value& friction) {
  return friction > Value(0.0) && !(way > Value(0.0) || way < Value(0.0));
}

/// Adds friction in the directions `way` to the `rates` without friction. If friction holds a
/// motion, its acceleration becomes 0.
template <class T>
State<T> with_friction(const FrictionRates<T>& friction, const Sliding<ValueOf<T>>& way,
                       State<T> rates) {
  using math::select;
  rates.u_mps = select(is_held(way.surge, value_of(friction.surge_mps2)), T(0.0),
                       T(rates.u_mps - way.surge * friction.surge_mps2));
  rates.r_radps = select(is_held(way.yaw, value_of(friction.yaw_radps2)), T(0.0),
                         T(rates.r_radps - way.yaw * friction.yaw_radps2));
  return rates;
}

/// Fraction of a step after which the speed is 0, if it changes linearly from `from` to `to`. 1 if
/// the speed does not pass 0, or starts at 0. `way`: direction of sliding in this step.
template <class T>
T share_until_rest(const ValueOf<T>& way, const T& from, const T& to) {
  using math::select;
  using Value = ValueOf<T>;
  const auto passes = way * value_of(from) > Value(0.0) && way * value_of(to) < Value(0.0);
  return select(passes, T(from / (from - to)), T(1.0));
}

/// Maximum number of stops at which one step is cut; the rest of the step is integrated without
/// cuts.
inline constexpr int kMaxStopsInAStep = 4;

/// One integration step with Coulomb friction: the state h seconds after s. `rates(state)`: the
/// rates without friction. `step(s, h, rates)`: one step without friction, such as rk4_step().
///
/// In a batch, each lane is cut at its own stops. A lane without a cut makes its whole step, then
/// steps of 0 s, which do not change it.
template <class T, class Rates, class Step>
State<T> step_with_friction(const FrictionRates<T>& friction, State<T> s, T h, const Rates& rates,
                            const Step& step) {
  using math::any;
  using math::select;
  if (!friction.any()) return step(s, h, rates);
  for (int cuts = 0;; ++cuts) {
    const auto way = sliding(friction, s, rates(s));
    const auto slid = [&](const State<T>& at) { return with_friction(friction, way, rates(at)); };
    const State<T> next = step(s, h, slid);
    const T surge = share_until_rest(way.surge, s.u_mps, next.u_mps);
    const T yaw = share_until_rest(way.yaw, s.r_radps, next.r_radps);
    const auto surge_first = value_of(surge) <= value_of(yaw);
    const T share = select(surge_first, surge, yaw);
    const auto stops = value_of(share) < ValueOf<T>(1.0);
    if (!any(stops) || cuts == kMaxStopsInAStep) return next;
    s = step(s, T(share * h), slid);
    s.u_mps = select(stops && surge_first, T(0.0), s.u_mps);
    s.r_radps = select(stops && !surge_first, T(0.0), s.r_radps);
    h = T((T(1.0) - share) * h);
  }
}

/// step_with_friction() by the Runge-Kutta method.
template <class T, class Rates>
State<T> rk4_step_with_friction(const FrictionRates<T>& friction, const State<T>& s, const T& h,
                                const Rates& rates) {
  return step_with_friction(friction, s, h, rates,
                            [](const State<T>& from, const T& length, const auto& d) {
                              return rk4_step(from, length, d);
                            });
}

}  // namespace awmr
