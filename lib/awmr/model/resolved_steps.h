/// Runge-Kutta steps that are halved if the motion changes too fast for them. Templates on the
/// scalar: a double, or a batch of several doubles (lanes), one per simulated trajectory
/// (simulate/vehicle_steps.h).
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/runge_kutta.h"

namespace awmr {

/// Largest permitted product of a rate of decay (1/s) and a Runge-Kutta step (s). Up to 1,
/// deviations decay without a change of sign. Above 2.78, the method is unstable.
inline constexpr double kMaxRateTimesStep = 1.0;

/// Limits that keep a run from taking too long: successive halvings of one step, and number of
/// halved steps in the run. A run that exceeds one of them fails.
inline constexpr int kMaxHalvings = 40;
inline constexpr double kMaxHalves = 5e7;

/// Rate at which a small deviation from the speed w decays, 1/s: g'(w)/inertia with
///   g'(w) = alpha beta |w|^(beta-1) + 2 q |w|
/// Returns 0 where the rate needs no check: below law.rest_speed, where the chord replaces g; and
/// for beta < 1 with q = 0. In both cases, the rate is at most 1/h for steps of h, because
/// rest_speed() in steady.h chooses the chord accordingly.
template <class T>
T decay_rate(const Resistance<T>& law, const T& inertia, const T& speed) {
  using math::abs;
  using math::any;
  using math::pow;
  using math::select;
  const T w = abs(speed);
  const Mask<T> counts = (law.beta >= T(1.0) || law.quadratic > T(0.0)) && !(w < law.rest_speed);
  if (!any(counts)) return T(0.0);
  // Lanes (vehicles of a batch) at rest, and lanes whose result is 0, compute pow() with the speed
  // 1, because pow() is not valid for them. The select() calls below replace their results.
  const Mask<T> moves = w > T(0.0);
  const T power = pow(select(counts && moves, w, T(1.0)), T(law.beta - T(1.0)));
  const T share = select(moves || !(law.beta > T(1.0)), power, T(0.0));
  const T slope = select(law.beta > T(0.0), T(law.alpha * law.beta * share), T(0.0));
  return select(counts, T((slope + T(2.0) * law.quadratic * w) / inertia), T(0.0));
}

/// The largest of three rates at the state `at`, 1/s: the decay of the speed u by the surge
/// resistance g1; the decay of the yaw rate r by the yaw resistance g3; and |r|, the rate at which
/// the velocity rotates in the vehicle's frame (terms m' r v and m' r u).
template <class T>
T fastest_rate(const Plant<T>& plant, const State<T>& at) {
  using math::abs;
  using math::select;
  const T turning = abs(at.r_radps);
  const T surge = decay_rate(plant.surge, plant.mass_norm, at.u_mps);
  const T yaw = decay_rate(plant.yaw, plant.inertia_norm, at.r_radps);
  const T faster = select(turning < surge, surge, turning);
  return select(faster < yaw, yaw, faster);
}

/// `a` in the lanes whose mask is true, else `b`.
template <class T>
State<T> blend(const Mask<T>& mask, const State<T>& a, const State<T>& b) {
  using math::select;
  return {select(mask, a.x_m, b.x_m),
          select(mask, a.y_m, b.y_m),
          select(mask, a.psi_rad, b.psi_rad),
          select(mask, a.u_mps, b.u_mps),
          select(mask, a.v_mps, b.v_mps),
          select(mask, a.r_radps, b.r_radps),
          select(mask, a.steering_rad, b.steering_rad)};
}

/// Result of the step control, by lane: whether the integration steps were short enough.
template <class T>
struct Resolution {
  T halves = T(0.0);                 ///< number of steps halved so far
  Mask<T> resolved = Mask<T>(true);  ///< false: no step is short enough, or a number is not finite
};

/// Declared here, because advance() and advance_by_halves() call each other. `body`: a Plant or
/// another type with a fastest_rate(), such as FourWheels (tyres.h). `step(from, h)` returns the
/// state after one integration step, without step control.
template <class Body, class T, class Step>
State<T> advance(const Body& body, const State<T>& from, const T& h, const Step& step,
                 const Mask<T>& requested, int halvings, Resolution<T>& resolution);

/// Replaces one step of h seconds by two steps of h/2, in the lanes of `requested`. A lane that
/// would exceed kMaxHalvings or kMaxHalves keeps its state and is marked as unresolved.
template <class Body, class T, class Step>
AWMR_COLD State<T> advance_by_halves(Body body, State<T> from, T h, Step step, Mask<T> requested,
                                     int halvings, Resolution<T>& resolution) {
  using math::any;
  using math::select;
  const Mask<T> too_many =
      requested && (Mask<T>(halvings == kMaxHalvings) || resolution.halves >= T(kMaxHalves));
  resolution.resolved = resolution.resolved && !too_many;
  const Mask<T> halved = requested && resolution.resolved;
  if (!any(halved)) return from;
  resolution.halves = select(halved, T(resolution.halves + T(1.0)), resolution.halves);
  const T half = h / T(2.0);
  const State<T> middle = advance(body, from, half, step, halved, halvings + 1, resolution);
  const State<T> end = advance(body, middle, half, step, halved, halvings + 1, resolution);
  return blend(halved, end, from);
}

/// Makes one step of h seconds if fastest_rate() times h is at most kMaxRateTimesStep at both ends
/// of the step. If it is not, makes two steps of half the length. The result is undefined in lanes
/// outside of `requested`.
template <class Body, class T, class Step>
State<T> advance(const Body& body, const State<T>& from, const T& h, const Step& step,
                 const Mask<T>& requested, int halvings, Resolution<T>& resolution) {
  using math::all;
  using math::any;
  const T most = T(kMaxRateTimesStep);
  Mask<T> fits = fastest_rate(body, from) * h <= most;
  State<T> to = from;
  if (any(fits)) {
    to = step(from, h);
    fits = fits && fastest_rate(body, to) * h <= most;
    if (all(fits || !requested)) return to;
  }
  return blend(fits, to,
               advance_by_halves(body, from, h, step, requested && !fits, halvings, resolution));
}

/// True in the lanes in which every number of the state is finite: 0 times an infinite number or
/// NaN is NaN.
template <class T>
Mask<T> is_finite(const State<T>& s) {
  using math::abs;
  const T none = T(0.0) * s.x_m + T(0.0) * s.y_m + T(0.0) * s.psi_rad + T(0.0) * s.u_mps +
                 T(0.0) * s.v_mps + T(0.0) * s.r_radps + T(0.0) * s.steering_rad;
  return abs(none) <= T(0.0);
}

/// Returns the speed, or 0 if its magnitude is below 1e-150. Products of such speeds can be
/// subnormal numbers, with which arithmetic is slow.
template <class T>
T settled(const T& speed) {
  using math::abs;
  using math::select;
  return select(abs(speed) < T(1e-150), T(0.0), speed);
}

/// Integrates the lanes of `requested` by `substeps` steps of h seconds at constant commands. A
/// lane in which no step is short enough, or a number is not finite, keeps its state and is marked
/// in `resolution`.
template <class Body, class T, class Step>
void integrate(const Body& body, const T& h, const T& substeps, const Step& step,
               const Mask<T>& requested, State<T>& state, Resolution<T>& resolution) {
  using math::all;
  using math::any;
  State<T> moved = state;
  for (int i = 0;; ++i) {
    const Mask<T> steps = requested && resolution.resolved && T(i) < substeps;
    if (!any(steps)) break;
    const State<T> next = advance(body, moved, h, step, steps, 0, resolution);
    moved = all(steps) ? next : blend(steps, next, moved);
  }
  resolution.resolved = resolution.resolved && (is_finite(moved) || !requested);
  moved.u_mps = settled(moved.u_mps);
  moved.v_mps = settled(moved.v_mps);
  moved.r_radps = settled(moved.r_radps);
  state = blend(requested && resolution.resolved, moved, state);
}

}  // namespace awmr
