/// Four-wheel tyre model, to cross-check the 3-DOF vehicle of dynamics.h. Each tyre makes a side
/// force from its slip, and its total force stays within its circle of friction. Templates on the
/// scalar.
///
/// The side force is that of the brush model, in the form of Fiala: H. B. Pacejka, "Tire and
/// Vehicle Dynamics", 3rd ed., 3.2.1. VEHICLES.md in this folder lists the parts of the 3-DOF model
/// that are kept or replaced.
#pragma once

#include "awmr/core/gravity.h"
#include "awmr/core/tyre_friction.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/resolved_steps.h"
#include "awmr/model/rest.h"

namespace awmr {

/// Tyre parameters, the same for all four.
template <class T>
struct Tyres {
  /// mu, > 0: largest force between tyre and ground in any direction, divided by the load on the
  /// wheel
  T friction = T(kTyreFriction);
  /// c_a, 1/rad, > 0: cornering stiffness over the load on the wheel, the slope of the side force
  /// at a small slip angle.
  T cornering_per_rad = T(kCorneringStiffness_per_rad);
  /// Rest speed v_0, m/s, > 0, without which the slip of a wheel at rest would be undefined. A
  /// wheel that rolls more slowly is treated as rolling at about this speed. Its tyre then resists
  /// like a viscous fluid, so a vehicle that is pushed sideways at rest creeps. The larger v_0, the
  /// faster it creeps.
  T rest_speed_mps = T(kTyreRestSpeed_mps);
};

/// A vehicle on four tyres. The sway resistance g2 and the yaw resistance g3 of `body` are not
/// used.
template <class T>
struct FourWheels {
  Plant<T> body;
  Tyres<T> tyres;
};

/// Load on each wheel if all four carry the same, divided by F_max:
///   F'z = m' g/4
template <class T>
T wheel_load(const T& mass_norm) {
  return mass_norm * T(kGravity_mps2 / 4.0);
}

/// Returns the largest possible scrub moment, divided by F_max, m. All four tyres slide sideways
/// while the vehicle turns on the spot; the centre of gravity is assumed half-way between the
/// axles.
///   mu g m' l_f,   mu = kTyreFriction
template <class T>
T sliding_moment_m(const Plant<T>& plant) {
  return T(kTyreFriction * kGravity_mps2) * plant.mass_norm * plant.front_axle_m;
}

/// Sideways speed of each wheel, m/s, left positive, perpendicular to its rolling direction
/// (wheel_speeds()). The rear axle is assumed as far behind the centre of gravity as the front axle
/// is ahead of it:
///   s_rear  = v - l_f r
///   s_front = (v + l_f r) cos d_r - (u -+ d r) sin d_r         upper sign: left, lower: right
template <class T>
WheelSpeeds<T> side_speeds(const T& front_axle_m, const T& half_track_m, const State<T>& s) {
  using math::cos;
  using math::sin;
  const T across_mps = (s.v_mps + front_axle_m * s.r_radps) * cos(s.steering_rad);
  const T sin_d = sin(s.steering_rad);
  const T rear_mps = s.v_mps - front_axle_m * s.r_radps;
  return {across_mps - (s.u_mps - half_track_m * s.r_radps) * sin_d,
          across_mps - (s.u_mps + half_track_m * s.r_radps) * sin_d, rear_mps, rear_mps};
}

/// The side force F'y of a tyre divided by F_max, positive to the left. The wheel carries the load
/// F'z, rolls at w (`rolls_mps`), slides to its left at s (`slides_mps`) and has the longitudinal
/// force F'x (`along`), |F'x| <= mu F'z:
///   F'm = sqrt((mu F'z)^2 - F'x^2)                  remainder of the circle of friction
///   sigma = s/sqrt(w^2 + v_0^2)                     the tangent of the slip angle
///   z = min(c_a F'z |sigma|/(3 F'm), 1)             1: all of the contact slides
///   F'y = -F'm (1 - (1 - z)^3) sgn sigma            = -c_a F'z sigma for a small sigma
template <class T>
T side_force(const Tyres<T>& tyres, const T& load, const T& along, const T& rolls_mps,
             const T& slides_mps) {
  using math::abs;
  using math::larger;
  using math::select;
  using math::sqrt;
  const T grip = tyres.friction * load;
  const T left_over = sqrt(larger(T(0.0), T(grip * grip - along * along)));
  const T rolls = sqrt(rolls_mps * rolls_mps + tyres.rest_speed_mps * tyres.rest_speed_mps);
  const T elastic = tyres.cornering_per_rad * load * abs(slides_mps) / rolls;
  // If F'm is 0, the quotient in z is undefined; the force is then 0.
  const Mask<T> slides = !(elastic < T(3.0) * left_over);
  const T sticks = T(1.0) - elastic / select(slides, T(1.0), T(T(3.0) * left_over));
  const T force = select(slides, left_over, T(left_over * (T(1.0) - sticks * sticks * sticks)));
  return select(slides_mps > T(0.0), T(-force), force);
}

/// Force of the ground on a wheel along its rolling direction, divided by F_max. It is the motor's
/// force F' (motor_force()) minus a quarter of g1, limited by tyre friction. g1 is assumed to act
/// in the drive, between motor and ground.
///   F'x = sat(F' - g1(w)/4, mu F'z)
template <class T>
T ground_force(const FourWheels<T>& p, const T& load, const T& command, const T& rolls_mps) {
  const T drive = beyond_dead_zone(command, p.body.wheel_dead_zone);
  const T force = motor_force(drive, p.body.back_emf_s_per_m, rolls_mps);
  return math::saturate(T(force - T(0.25) * p.body.surge(rolls_mps)), T(p.tyres.friction * load));
}

/// Forces of the ground on the four wheels, at one time.
template <class T>
struct TyreForces {
  WheelForces<T> along;   ///< along the wheel, forward positive, divided by F_max
  WheelForces<T> across;  ///< perpendicular to the wheel, left positive, divided by F_max
};

template <class T>
TyreForces<T> tyre_forces(const FourWheels<T>& p, const State<T>& s, const WheelForces<T>& f) {
  const WheelSpeeds<T> w = wheel_speeds(p.body.front_axle_m, p.body.half_track_m, s);
  const WheelSpeeds<T> slides = side_speeds(p.body.front_axle_m, p.body.half_track_m, s);
  const T load = wheel_load(p.body.mass_norm);
  TyreForces<T> made;
  made.along = {ground_force(p, load, f.front_left, w.front_left),
                ground_force(p, load, f.front_right, w.front_right),
                ground_force(p, load, f.rear_left, w.rear_left),
                ground_force(p, load, f.rear_right, w.rear_right)};
  const auto across = [&](const T& along, const T& rolls_mps, const T& slides_mps) {
    return side_force(p.tyres, load, along, rolls_mps, slides_mps);
  };
  made.across = {across(made.along.front_left, w.front_left, slides.front_left),
                 across(made.along.front_right, w.front_right, slides.front_right),
                 across(made.along.rear_left, w.rear_left, slides.rear_left),
                 across(made.along.rear_right, w.rear_right, slides.rear_right)};
  return made;
}

/// Power dissipated by tyres that slide sideways at the speeds s_i (side_speeds()), divided by
/// F_max, m/s, >= 0:
///   P = -sum of F'y_i s_i
template <class T, class Forces>
T tyre_power_mps(const FourWheels<T>& p, const State<T>& s, const Forces& f) {
  const WheelForces<T> y = tyre_forces(p, s, by_wheel(p.body.rear_driven, f)).across;
  const WheelSpeeds<T> slides = side_speeds(p.body.front_axle_m, p.body.half_track_m, s);
  return -((y.front_left * slides.front_left + y.front_right * slides.front_right) +
           (y.rear_left * slides.rear_left + y.rear_right * slides.rear_right));
}

/// Rates of the state of a vehicle on four tyres. In the body's frame, the forces of a front wheel
/// i are
///   X_i = F'x cos d_r - F'y sin d_r,   Y_i = F'x sin d_r + F'y cos d_r
/// and those of a rear wheel are F'x and F'y. The equations of Newton and Euler are those of
/// [paper (39)] with tyre forces in place of the resistances:
///   u_dot = (sum of X_i)/m' + r v
///   v_dot = (sum of Y_i)/m' - r u
///   r_dot = (l_f (Y_FL + Y_FR - Y_RL - Y_RR) + d (X_FR - X_FL + X_RR - X_RL))/I'z
template <class T, class Forces>
State<T> state_rates(const FourWheels<T>& p, const State<T>& s, const Forces& f,
                     const T& steering_command_rad) {
  using math::cos;
  using math::sin;
  const TyreForces<T> made = tyre_forces(p, s, by_wheel(p.body.rear_driven, f));
  const WheelForces<T>& x = made.along;
  const WheelForces<T>& y = made.across;
  const T cos_d = cos(s.steering_rad);
  const T sin_d = sin(s.steering_rad);
  const T front = x.front_left + x.front_right;
  const T front_across = y.front_left + y.front_right;
  const T rear_across = y.rear_left + y.rear_right;
  const T front_sway = front * sin_d + front_across * cos_d;
  const T turning = (x.front_right - x.front_left) * cos_d -
                    (y.front_right - y.front_left) * sin_d + (x.rear_right - x.rear_left);
  const T cos_psi = cos(s.psi_rad);
  const T sin_psi = sin(s.psi_rad);
  State<T> d{};
  d.x_m = s.u_mps * cos_psi - s.v_mps * sin_psi;
  d.y_m = s.u_mps * sin_psi + s.v_mps * cos_psi;
  d.psi_rad = s.r_radps;
  d.u_mps =
      (front * cos_d - front_across * sin_d + (x.rear_left + x.rear_right)) / p.body.mass_norm +
      s.r_radps * s.v_mps;
  d.v_mps = (front_sway + rear_across) / p.body.mass_norm - s.r_radps * s.u_mps;
  d.r_radps = (p.body.front_axle_m * (front_sway - rear_across) + p.body.half_track_m * turning) /
              p.body.inertia_norm;
  d.steering_rad = steering_rate(p.body, s.steering_rad, steering_command_rad);
  return d;
}

/// Smallest inertia m'_w, s^2/m, that opposes a force along the rolling direction of a wheel. The
/// force accelerates the vehicle (m') or turns it (I'z). The lever of the force is at most the
/// distance of the wheel from the centre of gravity:
///   m'_w = min(m', I'z/(l_f^2 + d^2))
template <class T>
T rolling_inertia(const Plant<T>& p) {
  using math::select;
  const T turning =
      p.inertia_norm / (p.front_axle_m * p.front_axle_m + p.half_track_m * p.half_track_m);
  return select(turning < p.mass_norm, turning, p.mass_norm);
}

/// As resolved_at_rest() of rest.h, but for a vehicle on tyres, on which the surge resistance g1
/// acts at the wheels.
inline Plant<double> resolved_at_rest_on_tyres(const Plant<double>& body, double step_s) {
  Plant<double> resolved = resolved_at_rest(body, step_s);
  resolved.surge.rest_speed = rest_speed(body.surge, rolling_inertia(body), step_s);
  return resolved;
}

/// Upper bound of the rate at which the tyres damp a sideways motion, 1/s. Each wheel damps it with
/// its stiffness c_a F'z divided by its rolling speed V_i:
///   max(1/m' sum_i c_a F'z/V_i,  1/I'z sum_i a_i^2 c_a F'z/V_i),   V_i = sqrt(w_i^2 + v_0^2)
/// The first term is the rate of sway, the second that of yaw. The lever a_i is l_f at the rear; at
/// the front, sqrt(l_f^2 + d^2) is its upper bound for any steering angle. The rates of the coupled
/// motion are at most twice the larger term.
template <class T>
T tyre_rate(const FourWheels<T>& p, const State<T>& s) {
  using math::sqrt;
  const WheelSpeeds<T> w = wheel_speeds(p.body.front_axle_m, p.body.half_track_m, s);
  const T rest_mps2 = p.tyres.rest_speed_mps * p.tyres.rest_speed_mps;
  const auto slowness = [&](const T& rolls_mps) {
    return T(1.0) / sqrt(rolls_mps * rolls_mps + rest_mps2);
  };
  const T front = slowness(w.front_left) + slowness(w.front_right);
  const T rear = slowness(w.rear_left) + slowness(w.rear_right);
  const T stiffness = p.tyres.cornering_per_rad * wheel_load(p.body.mass_norm);
  const T axle_m2 = p.body.front_axle_m * p.body.front_axle_m;
  const T wheel_m2 = axle_m2 + p.body.half_track_m * p.body.half_track_m;
  return stiffness * math::larger(T((front + rear) / p.body.mass_norm),
                                  T((wheel_m2 * front + axle_m2 * rear) / p.body.inertia_norm));
}

/// The largest of three rates at the state `at`, 1/s: |r|, at which the velocity rotates in the
/// vehicle's frame; the damping by the tyres; and the decay by g1 at the speed of the fastest
/// wheel.
template <class T>
T fastest_rate(const FourWheels<T>& vehicle, const State<T>& at) {
  using math::abs;
  using math::larger;
  const Plant<T>& body = vehicle.body;
  const WheelSpeeds<T> w = wheel_speeds(body.front_axle_m, body.half_track_m, at);
  const T fastest_mps = larger(larger(T(abs(w.front_left)), T(abs(w.front_right))),
                               larger(T(abs(w.rear_left)), T(abs(w.rear_right))));
  const T rolling = decay_rate(body.surge, rolling_inertia(body), fastest_mps);
  return larger(larger(T(abs(at.r_radps)), tyre_rate(vehicle, at)), rolling);
}

}  // namespace awmr
