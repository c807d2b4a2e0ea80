/// The vehicle's motion over one sample: Runge-Kutta steps that are halved where the motion is too
/// fast for them. Templates on the scalar: a double, or a batch with a trajectory per lane
/// (vehicle_steps.h). Private to this folder.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/runge_kutta.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// The largest product of a rate (1/s) and an RK4 step: a deviation that dies out at this rate
/// does so without changing its sign, and Runge-Kutta is stable to 2.78.
inline constexpr double kMostRateTimesStep = 1.0;

/// A step is halved at most this often, and a run has at most so many halves.
inline constexpr int kMostHalvings = 40;
inline constexpr double kMostHalves = 5e7;

/// What pushes the vehicle over a sample other than its wheels.
template <class T>
struct Push {
  BodyLoadOf<T> load;               ///< of the disturbances
  bool is_loaded = false;           ///< false: neither load nor slope
  bool is_sloped = false;           ///< the ground falls
  double slope_accel_mps2 = 0.0;    ///< m g sin(slope) over m: the same for every vehicle
  double slope_downhill_rad = 0.0;  ///< the heading in which it falls
};

/// First-order lag of the motors over a sample, from the force F that they have at its start to a
/// command c that is held:
///   F(t) = c + (F - c) exp(-t/tau),   mean = c + (F - c) (1 - exp(-T_s/tau)) tau/T_s
struct MotorLag {
  double left_over = 0.0;   ///< exp(-T_s/tau)
  double mean_share = 0.0;  ///< (1 - exp(-T_s/tau)) tau/T_s; 0: no lag
};

/// The mean force over the sample; `motors` is F, and then that at the sample's end.
template <class T>
SideForces<T> through_motors(const MotorLag& lag, const SideForces<T>& command,
                             SideForces<T>& motors) {
  if (!(lag.mean_share > 0.0)) return command;
  const T left_over = T(lag.left_over);
  const T mean_share = T(lag.mean_share);
  const SideForces<T> behind{motors.left - command.left, motors.right - command.right};
  motors = {command.left + behind.left * left_over, command.right + behind.right * left_over};
  return {command.left + behind.left * mean_share, command.right + behind.right * mean_share};
}

/// The same force at both wheels of a side; the rear ones where they are driven (Plant::rear_driven).
template <class T>
WheelForces<T> at_all_wheels(const SideForces<T>& force, const T& rear_driven) {
  return {force.left, force.right, rear_driven * force.left, rear_driven * force.right};
}

/// What arrives of commands at motors with back-EMF: one that is commanded 0 is off at once, as it
/// would brake for as long as a lag leaves it anything (motor_force() in dynamics.h).
template <class T>
SideForces<T> switched_off(const T& back_emf_s_per_m, const SideForces<T>& command,
                           const SideForces<T>& arriving) {
  using math::abs;
  using math::select;
  const Mask<T> ideal = !(back_emf_s_per_m > T(0.0));
  return {select(ideal || abs(command.left) > T(0.0), arriving.left, T(0.0)),
          select(ideal || abs(command.right) > T(0.0), arriving.right, T(0.0))};
}

/// Both forces, no larger than `most` either way.
template <class T>
SideForces<T> up_to(const SideForces<T>& force, const T& most) {
  return {math::saturate(force.left, most), math::saturate(force.right, most)};
}

/// What the voltage s of a battery that sags, over that without current, leaves of both forces. The
/// current of motor i, over its stall current, is s c_i - k_e w_i, of which the battery carries the
/// share c_i for which the motor is on:
///   s = 1 - rho sum c_i (s c_i - k_e w_i)
///     = (1 + rho k_e sum c_i w_i) / (1 + rho sum c_i^2)
/// c: commands F'; rho: Battery::sag; w_i = u -+ d r of the sample's start, m/s, as if the wheels were straight.
/// The voltage is that over the whole sample.
template <class T>
SideForces<T> under_sag(double sag, const T& motors_a_side, const T& back_emf_s_per_m,
                        const T& half_track_m, const State<T>& at, const SideForces<T>& force) {
  const T rho = T(sag) * motors_a_side;
  const T squares = force.left * force.left + force.right * force.right;
  const T turning = force.left * (at.u_mps - half_track_m * at.r_radps) +
                    force.right * (at.u_mps + half_track_m * at.r_radps);
  const T voltage = (T(1.0) + rho * back_emf_s_per_m * turning) / (T(1.0) + rho * squares);
  return {force.left * voltage, force.right * voltage};
}

/// What pushes the vehicle, added to the rates of its state.
template <class T>
State<T> with_push(State<T> d, const Plant<T>& plant, const Push<T>& push, const State<T>& at) {
  using math::cos;
  using math::sin;
  if (!push.is_loaded) return d;
  d.u_mps += push.load.surge / plant.mass_norm;
  d.v_mps += push.load.sway / plant.mass_norm;
  d.r_radps += push.load.yaw_m / plant.inertia_norm;
  if (push.is_sloped) {
    const T downhill_rad = T(push.slope_downhill_rad) - at.psi_rad;
    d.u_mps += T(push.slope_accel_mps2) * cos(downhill_rad);
    d.v_mps += T(push.slope_accel_mps2) * sin(downhill_rad);
  }
  return d;
}

/// Rates of the state with what pushes the vehicle.
template <class T, class Forces>
State<T> pushed_rates(const Plant<T>& plant, const Push<T>& push, const State<T>& at,
                      const Forces& force, const T& steering_command_rad) {
  return with_push(state_rates(plant, at, force, steering_command_rad), plant, push, at);
}

/// g'(w)/inertia, at which a deviation from the speed w dies out:
///   g'(w) = alpha beta |w|^(beta-1) + 2 q |w|
/// For beta <= 1 it falls with |w| and is below 1/h from the chord's end on, by the choice of h.
template <class T>
T decay_rate(const Resistance<T>& law, const T& inertia, const T& speed) {
  using math::abs;
  using math::any;
  using math::pow;
  using math::select;
  const T w = abs(speed);
  const Mask<T> counts = (law.beta >= T(1.0) || law.quadratic > T(0.0)) && !(w < law.rest_speed);
  if (!any(counts)) return T(0.0);
  // Lanes that do not count compute with a speed of 1, which is then left out.
  const Mask<T> moves = w > T(0.0);
  const T power = pow(select(counts && moves, w, T(1.0)), T(law.beta - T(1.0)));
  const T share = select(moves || !(law.beta > T(1.0)), power, T(0.0));
  const T slope = select(law.beta > T(0.0), T(law.alpha * law.beta * share), T(0.0));
  return select(counts, T((slope + T(2.0) * law.quadratic * w) / inertia), T(0.0));
}

/// Faster than this nothing of the plant changes at `at`: resistance that grows with speed, and
/// the turning of the velocity in the vehicle's frame (m' r v and m' r u), at r.
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

/// `a` where the mask holds, else `b`.
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

/// Whether the steps of a run can follow it.
template <class T>
struct Resolution {
  T halves = T(0.0);                 ///< steps that were halved so far
  Mask<T> resolved = Mask<T>(true);  ///< false: no step is short enough, or a number is not finite
};

/// `body` is a Plant or what else has a fastest_rate() of its own (four_wheel_motion.h); here and below.
template <class Body, class T, class Rates>
State<T> advance(const Body& body, const State<T>& from, const T& h, const Rates& rates,
                 const Mask<T>& asked, int halvings, Resolution<T>& resolution);

/// Two steps of half the length where `asked`; unresolved where they would be one too many.
template <class Body, class T, class Rates>
AWMR_COLD State<T> advance_by_halves(Body body, State<T> from, T h, Rates rates, Mask<T> asked,
                                     int halvings, Resolution<T>& resolution) {
  using math::any;
  using math::select;
  const Mask<T> too_many =
      asked && (Mask<T>(halvings == kMostHalvings) || resolution.halves >= T(kMostHalves));
  resolution.resolved = resolution.resolved && !too_many;
  const Mask<T> halved = asked && resolution.resolved;
  if (!any(halved)) return from;
  resolution.halves = select(halved, T(resolution.halves + T(1.0)), resolution.halves);
  const T half = h / T(2.0);
  const State<T> middle = advance(body, from, half, rates, halved, halvings + 1, resolution);
  const State<T> end = advance(body, middle, half, rates, halved, halvings + 1, resolution);
  return blend(halved, end, from);
}

/// One step of the classical Runge-Kutta method where it resolves the rates at both of its ends,
/// else two of half the length. What lanes hold that are not asked has no meaning.
template <class Body, class T, class Rates>
State<T> advance(const Body& body, const State<T>& from, const T& h, const Rates& rates,
                 const Mask<T>& asked, int halvings, Resolution<T>& resolution) {
  using math::all;
  using math::any;
  const T most = T(kMostRateTimesStep);
  Mask<T> fits = fastest_rate(body, from) * h <= most;
  State<T> to = from;
  if (any(fits)) {
    to = rk4_step(from, h, rates);
    fits = fits && fastest_rate(body, to) * h <= most;
    if (all(fits || !asked)) return to;
  }
  return blend(fits, to,
               advance_by_halves(body, from, h, rates, asked && !fits, halvings, resolution));
}

/// True where every number is finite: 0 times a number is NaN else.
template <class T>
Mask<T> is_finite(const State<T>& s) {
  using math::abs;
  const T none = T(0.0) * s.x_m + T(0.0) * s.y_m + T(0.0) * s.psi_rad + T(0.0) * s.u_mps +
                 T(0.0) * s.v_mps + T(0.0) * s.r_radps + T(0.0) * s.steering_rad;
  return abs(none) <= T(0.0);
}

/// A speed whose square would be below the normal range is rest: no crawl through subnormal
/// numbers.
template <class T>
T settled(const T& speed) {
  using math::abs;
  using math::select;
  return select(abs(speed) < T(1e-150), T(0.0), speed);
}

/// Moves the state on by `substeps` steps of h where `asked`, with the rates of held commands. Where
/// the motion is not resolved, the state stays as it was.
template <class Body, class T, class Rates>
void integrate(const Body& body, const T& h, const T& substeps, const Rates& rates,
               const Mask<T>& asked, State<T>& state, Resolution<T>& resolution) {
  using math::all;
  using math::any;
  State<T> moved = state;
  for (int i = 0;; ++i) {
    const Mask<T> steps = asked && resolution.resolved && T(i) < substeps;
    if (!any(steps)) break;
    const State<T> next = advance(body, moved, h, rates, steps, 0, resolution);
    moved = all(steps) ? next : blend(steps, next, moved);
  }
  resolution.resolved = resolution.resolved && (is_finite(moved) || !asked);
  moved.u_mps = settled(moved.u_mps);
  moved.v_mps = settled(moved.v_mps);
  moved.r_radps = settled(moved.r_radps);
  state = blend(asked && resolution.resolved, moved, state);
}

}  // namespace awmr
