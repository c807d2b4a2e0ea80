/// Equations of motion of the 3-DOF vehicle (surge, sway, yaw) and its steering servo. Templates on
/// the scalar: double, float, ceres::Jet.
///
/// README.md in this folder lists where each equation of the paper is implemented, and the errors
/// of the printed equations.
#pragma once

#include "awmr/model/resistance.h"
#include "awmr/model/scalar_math.h"
#include "awmr/model/state.h"

namespace awmr {

/// Parameters of the equations of motion. Every force is divided by F_max, the largest force of one
/// motor in N, so that forces are dimensionless and moments are in m.
template <class T>
struct Plant {
  /// g1(u), dimensionless: resistance to surge divided by F_max. From surge trials or a driven log.
  Resistance<T> surge;
  /// g3(r), m: resistance to yaw divided by F_max. From turning trials or a driven log.
  Resistance<T> yaw;
  /// a_s, s/m, > 0: resistance to sway divided by F_max, g2(v) = a_s v. From a log that measures
  /// sway, or given: the paper prints alpha_3 = 3, without a trial for it.           [paper App. B]
  T sway_alpha;
  /// m' = m/F_max, s^2/m, > 0. From a coast-down or a driven log.                      [paper (66)]
  T mass_norm;
  /// I'z = Iz/F_max, s^2 m, > 0. From m' and Iz, or a driven log.                      [paper (67)]
  T inertia_norm;
  /// l_f, m, > 0: from the centre of gravity forward to the front axle. Measured on the vehicle.
  T front_axle_m;
  /// d, m, > 0: from the centre line to the middle of a wheel. Measured on the vehicle.
  T half_track_m;
  /// d_max, rad, in (0, pi/2): stop of the front wheels, the same on either side. Data sheet.
  T steering_max_rad;
  /// d_rate_max, rad/s, > 0: the servo's maximum rate, in both directions. Data sheet.
  T steering_max_rate_radps;
  /// T, s, > 0: time constant of the servo's first-order lag. Data sheet, or a log of its angle.
  T steering_time_constant_s;
  /// F'0, >= 0: dead zone of the motors, the part of each wheel's force command (divided by F_max)
  /// that has no effect. 0: none, as in the paper. Estimated only in the families
  /// `dead-zone` and `dead-zone-coulomb`.
  T wheel_dead_zone = T(0.0);
  /// k_e, s/m, >= 0: back-EMF, the decrease of a motor's force, divided by F_max, per m/s at its
  /// wheel. 0: an ideal force source, as in the paper. Data sheet, or a log with driven and
  /// coasting sections.
  T back_emf_s_per_m = T(0.0);
  /// 1 if all four wheels are driven, as in the paper; 0 if only the front wheels are. Given.
  T rear_driven = T(1.0);
  /// c, m, >= 0: Coulomb yaw moment divided by F_max that tyre scrub adds to g3 in a differential
  /// turn, see scrub_moment_m(). state_rates() does not include it: the integration adds it, as
  /// friction (sliding.h). 0: none, as in the paper. From trials with differential turns.
  T yaw_scrub_m = T(0.0);
};

/// Fraction q of the yaw moment that comes from different left and right forces (tau_diff) and not
/// from the steering (tau_steering):
///   q = |tau_diff|/(|tau_diff| + |tau_steering|),   q = 0 without a moment
template <class T>
T differential_share(const T& tau_steering_m, const T& tau_diff_m) {
  using math::abs;
  using math::larger;
  const T differential = abs(tau_diff_m);
  return differential / larger(T(differential + abs(tau_steering_m)), T(1e-30));
}

/// Number n of driven wheels. Straight ahead, with the force F' at each of them, tau_speed = n F'.
template <class T>
T driven_wheels(const Plant<T>& p) {
  return T(2.0) + T(2.0) * p.rear_driven;
}

/// Rolling speed of each wheel, m/s, forward positive.
template <class T>
struct WheelSpeeds {
  T front_left;
  T front_right;
  T rear_left;
  T rear_right;
};

/// Computes the rolling speed of each wheel. The rear wheels roll along the body's x axis, the
/// front wheels along their steering angle d_r:
///   w_rear  =  u -+ d r                              upper sign: left, lower: right
///   w_front = (u -+ d r) cos d_r + (v + l_f r) sin d_r
template <class T>
WheelSpeeds<T> wheel_speeds(const T& front_axle_m, const T& half_track_m, const State<T>& s) {
  using math::cos;
  using math::sin;
  const T across_mps = (s.v_mps + front_axle_m * s.r_radps) * sin(s.steering_rad);
  const T cos_d = cos(s.steering_rad);
  const T left_mps = s.u_mps - half_track_m * s.r_radps;
  const T right_mps = s.u_mps + half_track_m * s.r_radps;
  return {left_mps * cos_d + across_mps, right_mps * cos_d + across_mps, left_mps, right_mps};
}

/// Force F' of a motor (divided by F_max) whose wheel rolls at w m/s. `drive` is e, the motor
/// command beyond the dead zone: the voltage divided by the voltage for F_max at standstill.
///   F' = e - k_e w    for e != 0: reduced by the back-EMF of the turning motor
///   F' = 0            for e  = 0: the motor is off and its wheel rolls freely
template <class T>
T motor_force(const T& drive, const T& back_emf_s_per_m, const T& wheel_mps) {
  using math::select;
  return select(drive > T(0.0) || drive < T(0.0), T(drive - back_emf_s_per_m * wheel_mps), T(0.0));
}

/// Upper bound of the rate at which back-EMF makes the speeds decay, 1/s. It is the larger of 4
/// k_e/m' (surge) and k_e (4 d^2 + 2 l_f^2)/I'z (yaw), with the symbols of Plant. It is 0 if the
/// motors have no back-EMF.
inline double back_emf_rate(const Plant<double>& p) {
  const double surge = 4.0 / p.mass_norm;
  const double yaw =
      (4.0 * p.half_track_m * p.half_track_m + 2.0 * p.front_axle_m * p.front_axle_m) /
      p.inertia_norm;
  return p.back_emf_s_per_m * (surge > yaw ? surge : yaw);
}

namespace detail {

/// Rates of the state under the resultant of the wheel forces. X = surge_force (forward) and Y =
/// sway_force (left) are forces divided by F_max; N = yaw_moment_m is the yaw moment divided by
/// F_max, m.
///   x_dot   = u cos psi - v sin psi
///   y_dot   = u sin psi + v cos psi
///   psi_dot = r
///   u_dot   = (X + m' r v - g1(u)) / m'
///   v_dot   = (Y - m' r u - g2(v)) / m',   g2(v) = a_s v
///   r_dot   = (N          - g3(r)) / I'z                                              [paper (39)]
template <class T>
State<T> rates(const Plant<T>& p, const State<T>& s, const T& surge_force, const T& sway_force,
               const T& yaw_moment_m, const T& steering_rate_radps) {
  using math::cos;
  using math::sin;
  const T cos_psi = cos(s.psi_rad);
  const T sin_psi = sin(s.psi_rad);
  // Reciprocals of mass and inertia, which are constant: divisions would take most of the time of a
  // batch of simulations.
  const T per_mass = T(1.0) / p.mass_norm;
  const T per_inertia = T(1.0) / p.inertia_norm;
  State<T> d{};
  d.x_m = s.u_mps * cos_psi - s.v_mps * sin_psi;
  d.y_m = s.u_mps * sin_psi + s.v_mps * cos_psi;
  d.psi_rad = s.r_radps;
  d.u_mps = (surge_force - p.surge(s.u_mps)) * per_mass + s.r_radps * s.v_mps;
  d.v_mps = (sway_force - p.sway_alpha * s.v_mps) * per_mass - s.r_radps * s.u_mps;
  d.r_radps = (yaw_moment_m - p.yaw(s.r_radps)) * per_inertia;
  d.steering_rad = steering_rate_radps;
  return d;
}

/// Force of each motor divided by F_max, reduced by the back-EMF at the rolling speed of its wheel.
/// `drive`: the motor commands beyond the dead zone.
template <class T>
AWMR_COLD WheelForces<T> motor_forces(const Plant<T>& p, const State<T>& s,
                                      const WheelForces<T>& drive) {
  const WheelSpeeds<T> w = wheel_speeds(p.front_axle_m, p.half_track_m, s);
  const T& k = p.back_emf_s_per_m;
  return {motor_force(drive.front_left, k, w.front_left),
          motor_force(drive.front_right, k, w.front_right),
          motor_force(drive.rear_left, k, w.rear_left),
          motor_force(drive.rear_right, k, w.rear_right)};
}

}  // namespace detail

/// Rate d_r_dot of the steering servo, rad/s: a first-order lag with the time constant T. The
/// commanded angle d_ro (rad, left positive) is limited to +-d_max, the rate to +-d_rate_max:
///   d_r_dot = sat((sat(d_ro, d_max) - d_r)/T, d_rate_max)                        [paper (43)-(44)]
template <class T>
T steering_rate(const Plant<T>& p, const T& steering_rad, const T& steering_command_rad) {
  const T target = math::saturate(steering_command_rad, p.steering_max_rad);
  const T per_time_constant = T(1.0) / p.steering_time_constant_s;
  return math::saturate(T((target - steering_rad) * per_time_constant), p.steering_max_rate_radps);
}

namespace detail {

/// The wheel forces F' that the motors make at these commands: the commands, reduced by dead zone
/// and back-EMF.
template <class T>
WheelForces<T> wheel_forces(const Plant<T>& p, const State<T>& s, const WheelForces<T>& command) {
  using math::any;
  const WheelForces<T> e{beyond_dead_zone(command.front_left, p.wheel_dead_zone),
                         beyond_dead_zone(command.front_right, p.wheel_dead_zone),
                         beyond_dead_zone(command.rear_left, p.wheel_dead_zone),
                         beyond_dead_zone(command.rear_right, p.wheel_dead_zone)};
  if (any(p.back_emf_s_per_m > T(0.0))) return motor_forces(p, s, e);
  return e;
}

/// The three terms of the yaw moment that the wheel forces make, divided by F_max, m: tau_steering,
/// and tau_diff of the front and of the rear axle.
template <class T>
struct YawMoments {
  T steering_m;    ///< l_f S_f sin d_r
  T front_diff_m;  ///< d cos d_r (F'FR - F'FL)
  T rear_diff_m;   ///< d (F'RR - F'RL)
  T sum_m() const { return steering_m + front_diff_m + rear_diff_m; }
};

template <class T>
YawMoments<T> yaw_moments(const Plant<T>& p, const WheelForces<T>& e, const T& cos_d,
                          const T& sin_d) {
  return {p.front_axle_m * (e.front_left + e.front_right) * sin_d,
          p.half_track_m * cos_d * (e.front_right - e.front_left),
          p.half_track_m * (e.rear_right - e.rear_left)};
}

}  // namespace detail

/// Rates of the state with an individual command for each motor, `f`. These commands, reduced by
/// dead zone and back-EMF, make the wheel forces F'. With the sum S_f = F'FL + F'FR at the front
/// and S_r = F'RL + F'RR at the rear, the rates of u, v and r are
///   u_dot = (S_f cos d_r + S_r + m' r v - g1(u)) / m'
///   v_dot = (S_f sin d_r       - m' r u - g2(v)) / m'
///   r_dot = (l_f S_f sin d_r + d cos d_r (F'FR - F'FL) + d (F'RR - F'RL) - g3(r)) / I'z
/// The rates of x, y and psi are those of detail::rates().                  [paper (39), corrected]
/// Corrected: in the printed r_dot, the rear term repeats the forces of the front wheels.
template <class T>
State<T> state_rates(const Plant<T>& p, const State<T>& s, const WheelForces<T>& f,
                     const T& steering_command_rad) {
  using math::cos;
  using math::sin;
  const T cos_d = cos(s.steering_rad);
  const T sin_d = sin(s.steering_rad);
  const WheelForces<T> e = detail::wheel_forces(p, s, f);
  const T front = e.front_left + e.front_right;
  const T rear = e.rear_left + e.rear_right;
  const T moment = detail::yaw_moments(p, e, cos_d, sin_d).sum_m();
  return detail::rates(p, s, front * cos_d + rear, front * sin_d, moment,
                       steering_rate(p, s.steering_rad, steering_command_rad));
}

/// Generalised forces: the thrust and the yaw moments that the left and right wheel forces make at
/// a steering angle. All are divided by F_max.
template <class T>
struct GeneralisedForces {
  T tau_speed;       ///< dimensionless: thrust along the body's x axis, forward positive
  T tau_steering_m;  ///< m: yaw moment of the steered front wheels, counter-clockwise positive
  T tau_diff_m;      ///< m: yaw moment of the right-left difference, counter-clockwise positive
};

/// Generalised forces of left and right wheel forces F'L, F'R at a steering angle d_r, with four
/// driven wheels, the front axle l_f ahead of the centre of gravity, and the half track d:
///   tau_speed    =     (F'L + F'R) (cos d_r + 1)
///   tau_steering = l_f (F'L + F'R)  sin d_r
///   tau_diff     = d   (F'R - F'L) (cos d_r + 1)                                      [paper (41)]
template <class T>
GeneralisedForces<T> generalised_forces(const T& front_axle_m, const T& half_track_m,
                                        const SideForces<T>& f, const T& steering_rad) {
  using math::cos;
  using math::sin;
  const T sum = f.left + f.right;
  const T one_plus_cos = cos(steering_rad) + T(1.0);
  return {sum * one_plus_cos, front_axle_m * sum * sin(steering_rad),
          half_track_m * (f.right - f.left) * one_plus_cos};
}

/// Generalised forces with only the front wheels driven. The equations are (41) of the paper
/// without the terms + 1, which come from the rear wheels:
///   tau_speed    =     (F'L + F'R) cos d_r
///   tau_steering = l_f (F'L + F'R) sin d_r
///   tau_diff     = d   (F'R - F'L) cos d_r
template <class T>
GeneralisedForces<T> front_wheel_forces(const T& front_axle_m, const T& half_track_m,
                                        const SideForces<T>& f, const T& steering_rad) {
  using math::cos;
  using math::sin;
  const T sum = f.left + f.right;
  const T cos_d = cos(steering_rad);
  return {sum * cos_d, front_axle_m * sum * sin(steering_rad),
          half_track_m * (f.right - f.left) * cos_d};
}

/// Yaw moment tau_turn divided by F_max, m, in a turning trial with steering: all wheels have the
/// same force F' (`wheel_force`), and the steering angle is d_r, rad.
///   tau_turn = 2 l_f F' sin d_r                                                       [paper (62)]
template <class T>
T steering_moment_m(const T& front_axle_m, const T& wheel_force, const T& steering_rad) {
  using math::sin;
  return T(2.0) * front_axle_m * wheel_force * sin(steering_rad);
}

/// Yaw moment tau_turn divided by F_max, m, in a turning trial without steering. d: half track;
/// `right_less_left` = F'R - F'L.
///   tau_turn = 2 d (F'R - F'L)                                                        [paper (41)]
template <class T>
T differential_moment_m(const T& half_track_m, const T& right_less_left) {
  return T(2.0) * half_track_m * right_less_left;
}

/// The left and right wheel forces at these commands, if the motors have the dead zone `zone`:
/// beyond_dead_zone() (resistance.h) of each command.
template <class T>
SideForces<T> beyond_dead_zone(const SideForces<T>& command, const T& zone) {
  return {beyond_dead_zone(command.left, zone), beyond_dead_zone(command.right, zone)};
}

/// Rates of the state if both wheels of a side have the same force, `f`. The rates of u, v and r
/// are
///   u_dot = (tau_speed               + m' r v - g1(u)) / m'
///   v_dot = (tau_steering/l_f        - m' r u - g2(v)) / m'
///   r_dot = (tau_steering + tau_diff          - g3(r)) / I'z                          [paper (40)]
/// The paper calls tau_steering + tau_diff tau_turn. The rates of x, y and psi are those of
/// detail::rates().
template <class T>
State<T> side_driven_rates(const Plant<T>& p, const State<T>& s, const SideForces<T>& f,
                           const T& steering_command_rad) {
  const GeneralisedForces<T> tau =
      generalised_forces(p.front_axle_m, p.half_track_m, f, s.steering_rad);
  const T per_lever = T(1.0) / p.front_axle_m;
  return detail::rates(p, s, tau.tau_speed, T(tau.tau_steering_m * per_lever),
                       tau.tau_steering_m + tau.tau_diff_m,
                       steering_rate(p, s.steering_rad, steering_command_rad));
}

/// The command of each wheel if both wheels of a side get the same command, `f`; 0 for rear wheels
/// that are not driven. `rear_driven`: Plant::rear_driven.
template <class T>
WheelForces<T> by_wheel(const T& rear_driven, const SideForces<T>& f) {
  return {f.left, f.right, rear_driven * f.left, rear_driven * f.right};
}
template <class T>
const WheelForces<T>& by_wheel(const T&, const WheelForces<T>& f) {
  return f;
}

/// Largest yaw moment N_c of tyre scrub divided by F_max, m, >= 0, in the state `s` with the motor
/// commands `f`, for each side or for each wheel. It resists the turn. In a differential turn,
/// the straight wheels are dragged sideways; in a steered turn, they roll. c = yaw_scrub_m is the
/// moment measured in differential turns. In other turns, c is multiplied by q,
/// differential_share():
///   N_c = c q
template <class T, class Forces>
T scrub_moment_m(const Plant<T>& p, const State<T>& s, const Forces& f) {
  using math::cos;
  using math::sin;
  const WheelForces<T> e = detail::wheel_forces(p, s, by_wheel(p.rear_driven, f));
  const detail::YawMoments<T> tau =
      detail::yaw_moments(p, e, T(cos(s.steering_rad)), T(sin(s.steering_rad)));
  return p.yaw_scrub_m * differential_share(tau.steering_m, T(tau.front_diff_m + tau.rear_diff_m));
}

/// Power N_c |r| that tyre scrub dissipates, divided by F_max, m/s, >= 0.
template <class T>
T scrub_power_mps(const Plant<T>& p, const State<T>& s, const SideForces<T>& f) {
  using math::abs;
  return scrub_moment_m(p, s, f) * abs(s.r_radps);
}

/// Rates of the state if both motors of a side have the same command, `f`. The equations for
/// individual wheels are used if front and rear forces can differ in spite of equal commands
/// (back-EMF, undriven rear wheels).
template <class T>
State<T> state_rates(const Plant<T>& p, const State<T>& s, const SideForces<T>& f,
                     const T& steering_command_rad) {
  using math::any;
  if (any(p.back_emf_s_per_m > T(0.0) || p.rear_driven < T(1.0))) {
    return state_rates(p, s, by_wheel(p.rear_driven, f), steering_command_rad);
  }
  return side_driven_rates(p, s, beyond_dead_zone(f, p.wheel_dead_zone), steering_command_rad);
}

}  // namespace awmr
