/// Integration with exact Coulomb friction: a vehicle can stop, be held at rest, and start again.
/// Templates on the scalar.
///
/// The surge resistance g1 has a Coulomb friction c: it jumps from -c to c at rest. During an
/// integration step, the friction keeps the direction s of the motion, 1 or -1. With the surge
/// force X of the wheels,
///   u_dot = (X - s c - (g1(u) - c sgn u))/m' + r v
/// If the speed u passes 0 in an integration step, the step is cut at the time at which u is 0.
/// Then friction holds the vehicle (u_dot = 0) as long as the driving force |X + m' r v| is at most
/// c. Yaw is treated in the same way. If a chord (rest.h) replaced the jump, a vehicle that
/// friction should hold at rest would creep.
///
/// Tyre scrub acts as a friction in yaw, in addition to the Coulomb friction of g3. Its moment
/// depends on the state and on the wheel forces (scrub_moment_m()), so the sum of both is computed
/// in each state (FrictionWithScrub).
#pragma once

#include "awmr/model/rest.h"
#include "awmr/model/runge_kutta.h"

namespace awmr {

/// The value of a number of type T, without derivatives; value_of() (rest.h) returns it.
template <class T>
using ValueOf = decltype(value_of(T()));

/// Decelerations by Coulomb friction: c divided by the inertia. As the friction of a vehicle, they
/// are the same in every state.
template <class T>
struct FrictionRates {
  T surge_mps2;  ///< c1/m', m/s^2, >= 0
  T yaw_radps2;  ///< c3/I'z, rad/s^2, >= 0
  /// The friction in a state; its upper bound in all states.
  const FrictionRates& in(const State<T>&) const { return *this; }
  const FrictionRates& most() const { return *this; }
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

/// Coulomb friction of a vehicle with tyre scrub.
template <class T, class Forces>
struct FrictionWithScrub {
  FrictionRates<T> coulomb;  ///< the friction without scrub
  const Plant<T>& plant;     ///< must outlive this object
  Forces command;            ///< motor commands, for each side or for each wheel

  FrictionRates<T> in(const State<T>& s) const {
    return with_scrub(scrub_moment_m(plant, s, command));
  }
  FrictionRates<T> most() const { return with_scrub(plant.yaw_scrub_m); }

 private:
  FrictionRates<T> with_scrub(const T& moment_m) const {
    return {coulomb.surge_mps2, T(coulomb.yaw_radps2 + moment_m / plant.inertia_norm)};
  }
};

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

/// Sliding of surge and yaw in one integration step.
template <class Value>
struct Sliding {
  /// Directions: 1 (forward, counter-clockwise), -1 (opposite), or 0 if friction holds the motion,
  /// or if there is no friction.
  Value surge = Value(0.0);
  Value yaw = Value(0.0);
  /// True if friction holds the motion at rest.
  Mask<Value> holds_surge = Mask<Value>(false);
  Mask<Value> holds_yaw = Mask<Value>(false);
};

/// Direction of sliding: the sign of `speed`. At rest: the sign of `rate`, the acceleration without
/// friction, or 0 if friction holds the motion, that is, if |rate| is at most the deceleration
/// `friction`. `most`: upper bound of the friction in all states; if it is 0, the direction is 0.
template <class Value>
Value slides(const Value& speed, const Value& rate, const Value& friction, const Value& most) {
  using math::select;
  const Value zero = Value(0.0);
  const Value released =
      select(rate > friction, Value(1.0), select(rate < -friction, Value(-1.0), zero));
  const Value way = select(speed > zero, Value(1.0), select(speed < zero, Value(-1.0), released));
  return select(most > zero, way, zero);
}

/// True if friction holds a motion (surge or yaw) at rest: there is friction, and the sliding
/// direction `way` is 0.
template <class Value>
Mask<Value> is_held(const Value& way, const Value& friction) {
  return friction > Value(0.0) && !(way > Value(0.0) || way < Value(0.0));
}

/// Sliding in an integration step that starts in the state s. `friction`: FrictionRates or
/// FrictionWithScrub. `rates`: the rates of this state without friction.
template <class T, class Friction>
Sliding<ValueOf<T>> sliding(const Friction& friction, const State<T>& s, const State<T>& rates) {
  const FrictionRates<T> here = friction.in(s);
  const FrictionRates<T> most = friction.most();
  const auto surge = slides(value_of(s.u_mps), value_of(rates.u_mps), value_of(here.surge_mps2),
                            value_of(most.surge_mps2));
  const auto yaw = slides(value_of(s.r_radps), value_of(rates.r_radps), value_of(here.yaw_radps2),
                          value_of(most.yaw_radps2));
  return {surge, yaw, is_held(surge, value_of(here.surge_mps2)),
          is_held(yaw, value_of(here.yaw_radps2))};
}

/// Adds friction (its decelerations in this state) in the directions `way` to the `rates` without
/// friction. If friction holds a motion, its acceleration becomes 0.
template <class T>
State<T> with_friction(const FrictionRates<T>& friction, const Sliding<ValueOf<T>>& way,
                       State<T> rates) {
  using math::select;
  rates.u_mps = select(way.holds_surge, T(0.0), T(rates.u_mps - way.surge * friction.surge_mps2));
  rates.r_radps = select(way.holds_yaw, T(0.0), T(rates.r_radps - way.yaw * friction.yaw_radps2));
  return rates;
}

/// Fraction of a step after which the speed is 0, if it changes linearly from `from` to `to`. 1 if
/// the speed does not pass 0, or starts at 0. `way`: direction of sliding, from slides(). If it is
/// 0, the result is 1 too: a motion (surge or yaw) without friction passes 0 without a stop.
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

/// One integration step with Coulomb friction: the state h seconds after s. `friction`:
/// FrictionRates or FrictionWithScrub. `rates(state)`: the rates without friction. `step(s, h,
/// rates)`: one step without friction, such as RungeKutta4.
///
/// In a batch, each lane is cut at its own stops. A lane without a cut makes its whole step, then
/// steps of 0 s, which do not change it.
template <class T, class Friction, class Rates, class Step = RungeKutta4>
State<T> step_with_friction(const Friction& friction, State<T> s, T h, const Rates& rates,
                            const Step& step = {}) {
  using math::any;
  using math::select;
  if (!friction.most().any()) return step(s, h, rates);
  for (int cuts = 0;; ++cuts) {
    const auto way = sliding(friction, s, rates(s));
    const auto slid = [&](const State<T>& at) {
      return with_friction<T>(friction.in(at), way, rates(at));
    };
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

}  // namespace awmr
