/// The 3-DOF vehicle and its steering servo. Templates on the scalar: double, float, ceres::Jet.
#pragma once

#include "awmr/model/resistance.h"
#include "awmr/model/scalar_math.h"
#include "awmr/model/state.h"

namespace awmr {

/// What the equations of motion need to know. All forces are over F_max, the largest force of one
/// motor.
template <class T>
struct Plant {
  Resistance<T> surge;        ///< g1(u), dimensionless
  Resistance<T> yaw;          ///< g3(r), m
  T sway_alpha;               ///< a_s in g2(v) = a_s v, s/m                          [paper App. B]
  T mass_norm;                ///< m' = m / F_max, s^2/m, > 0                          [paper (66)]
  T inertia_norm;             ///< I'z = Iz / F_max, s^2 m, > 0                        [paper (67)]
  T front_axle_m;             ///< l_f, centre of gravity to front axle, > 0
  T half_track_m;             ///< d, centre line to a wheel, > 0
  T steering_max_rad;         ///< stop of the front wheels, either side, > 0
  T steering_max_rate_radps;  ///< the servo's fastest turn, > 0
  T steering_time_constant_s;  ///< T, the servo's first-order lag, > 0
  T wheel_dead_zone = T(0.0);  ///< F'0, the part of each F' that moves nothing, >= 0
};

namespace detail {

/// Body rates from the resultant of the wheels: X, Y over F_max and the yaw moment over F_max in m.
template <class T>
State<T> rates(const Plant<T>& p, const State<T>& s, const T& surge_force, const T& sway_force,
               const T& yaw_moment_m, const T& steering_rate_radps) {
  using math::cos;
  using math::sin;
  const T cos_psi = cos(s.psi_rad);
  const T sin_psi = sin(s.psi_rad);
  State<T> d{};
  // x_dot = u cos psi - v sin psi;  y_dot = u sin psi + v cos psi;  psi_dot = r
  //                     [paper (39); (20), (29)-(31) corrected: sign of the g2 sin psi term in x]
  d.x_m = s.u_mps * cos_psi - s.v_mps * sin_psi;
  d.y_m = s.u_mps * sin_psi + s.v_mps * cos_psi;
  d.psi_rad = s.r_radps;
  // u_dot = (X + m' r v - g1(u)) / m'
  d.u_mps = (surge_force - p.surge(s.u_mps)) / p.mass_norm + s.r_radps * s.v_mps;
  // v_dot = (Y - m' r u - g2(v)) / m',  g2(v) = a_s v
  d.v_mps = (sway_force - p.sway_alpha * s.v_mps) / p.mass_norm - s.r_radps * s.u_mps;
  // r_dot = (N - g3(r)) / I'z
  d.r_radps = (yaw_moment_m - p.yaw(s.r_radps)) / p.inertia_norm;
  d.steering_rad = steering_rate_radps;
  return d;
}

}  // namespace detail

/// d_r_dot = sat((sat(d_ro, d_max) - d_r)/T, d_rate_max)                               [paper (44)]
template <class T>
T steering_rate(const Plant<T>& p, const T& steering_rad, const T& steering_command_rad) {
  const T target = math::saturate(steering_command_rad, p.steering_max_rad);
  return math::saturate((target - steering_rad) / p.steering_time_constant_s,
                        p.steering_max_rate_radps);
}

/// The four-wheel form, each wheel's force its own.
///   u_dot = (S_f cos d_r + S_r + m' r v - g1(u)) / m',   S_f = F'FL + F'FR,  S_r = F'RL + F'RR
///   v_dot = (S_f sin d_r - m' r u - g2(v)) / m'
///   r_dot = (l_f S_f sin d_r + d cos d_r (F'FR - F'FL) + d (F'RR - F'RL) - g3(r)) / I'z
/// [paper (39), corrected: the printed rear term repeats the front pair; (31): F'RR - F'RL]
template <class T>
State<T> state_rates(const Plant<T>& p, const State<T>& s, const WheelForces<T>& f,
                     const T& steering_command_rad) {
  using math::cos;
  using math::sin;
  const T cos_d = cos(s.steering_rad);
  const T sin_d = sin(s.steering_rad);
  const WheelForces<T> e{beyond_dead_zone(f.front_left, p.wheel_dead_zone),
                         beyond_dead_zone(f.front_right, p.wheel_dead_zone),
                         beyond_dead_zone(f.rear_left, p.wheel_dead_zone),
                         beyond_dead_zone(f.rear_right, p.wheel_dead_zone)};
  const T front = e.front_left + e.front_right;
  const T rear = e.rear_left + e.rear_right;
  const T moment = p.front_axle_m * front * sin_d +
                   p.half_track_m * cos_d * (e.front_right - e.front_left) +
                   p.half_track_m * (e.rear_right - e.rear_left);
  return detail::rates(p, s, front * cos_d + rear, front * sin_d, moment,
                       steering_rate(p, s.steering_rad, steering_command_rad));
}

/// tau_speed, tau_steering and tau_diff: what two side forces and a steering angle amount to.
template <class T>
struct GeneralisedForces {
  T tau_speed;       ///< dimensionless, forward positive
  T tau_steering_m;  ///< yaw moment of the steered front wheels over F_max, m
  T tau_diff_m;      ///< yaw moment of the right-left difference over F_max, m
};

/// tau_speed = (F'L + F'R)(cos d_r + 1),  tau_steering = l_f (F'L + F'R) sin d_r,
/// tau_diff = d (F'R - F'L)(cos d_r + 1)                                                [paper
/// (41)]
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

/// The reduced form, left and right pairs alike.
///   u_dot = (tau_speed + m' r v - g1(u)) / m'
///   v_dot = (tau_steering/l_f - m' r u - g2(v)) / m'
///   r_dot = (tau_steering + tau_diff - g3(r)) / I'z                                     [paper
///   (40)]
template <class T>
State<T> state_rates(const Plant<T>& p, const State<T>& s, const SideForces<T>& f,
                     const T& steering_command_rad) {
  const SideForces<T> effective{beyond_dead_zone(f.left, p.wheel_dead_zone),
                                beyond_dead_zone(f.right, p.wheel_dead_zone)};
  const GeneralisedForces<T> tau =
      generalised_forces(p.front_axle_m, p.half_track_m, effective, s.steering_rad);
  return detail::rates(p, s, tau.tau_speed, tau.tau_steering_m / p.front_axle_m,
                       tau.tau_steering_m + tau.tau_diff_m,
                       steering_rate(p, s.steering_rad, steering_command_rad));
}

}  // namespace awmr
