/// Forces on the vehicle over one sample: effects of motor lag, battery, disturbances and slopes.
/// Templates on the scalar type: double for a single run, or lanes::Lanes, a register with one run
/// per lane. Private to this folder.
#pragma once

#include "awmr/model/resolved_steps.h"
#include "awmr/model/sliding.h"
#include "awmr/model/tyres.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// External forces (disturbances, slope) over one sample.
template <class T>
struct ExternalForces {
  BodyLoadOf<T> load;               ///< forces and moment of the disturbances
  bool is_loaded = false;           ///< false: there is neither a disturbance nor a slope
  bool is_sloped = false;           ///< there is a slope
  double slope_accel_mps2 = 0.0;    ///< downhill acceleration g sin(slope angle)
  double slope_downhill_rad = 0.0;  ///< heading of the steepest descent, in the world frame
};

/// First-order lag of the motor forces over a sample. A force starts at F and approaches the
/// constant command c with the time constant tau. At the time t of the sample, which has the length
/// T_s:
///   F(t) = c + (F - c) exp(-t/tau),   mean = c + (F - c) (1 - exp(-T_s/tau)) tau/T_s
struct MotorLag {
  double left_over = 0.0;   ///< exp(-T_s/tau); 0: no lag
  double mean_share = 0.0;  ///< (1 - exp(-T_s/tau)) tau/T_s; 0: no lag
};

/// Returns the mean forces over the sample. `motors`: forces at the start of the sample; set to
/// those at its end. If the motors have no lag, returns the command and leaves `motors` unchanged.
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

/// Returns `arriving`, the motor forces after lag, with 0 for each motor whose command is 0: with
/// back-EMF, this command switches the motor off at once. If the lag kept the motor on for a while,
/// its back-EMF would brake the wheel (motor_force() in dynamics.h).
template <class T>
SideForces<T> switched_off(const T& back_emf_s_per_m, const SideForces<T>& command,
                           const SideForces<T>& arriving) {
  using math::abs;
  using math::select;
  const Mask<T> ideal = !(back_emf_s_per_m > T(0.0));
  return {select(ideal || abs(command.left) > T(0.0), arriving.left, T(0.0)),
          select(ideal || abs(command.right) > T(0.0), arriving.right, T(0.0))};
}

/// Limits both forces to [-most, most].
template <class T>
SideForces<T> up_to(const SideForces<T>& force, const T& most) {
  return {math::saturate(force.left, most), math::saturate(force.right, most)};
}

/// Scales both forces by the voltage s of a sagging battery, divided by its voltage without
/// current:
///   s = 1 - rho sum c_i (s c_i - k_e w_i)
///     = (1 + rho k_e sum c_i w_i) / (1 + rho sum c_i^2)
/// rho: Battery::sag. c_i: command F' of motor i, which is also the fraction of time in which PWM
/// connects the motor to the battery. k_e: back-EMF coefficient. s c_i - k_e w_i: current of the
/// motor divided by its stall current. w_i = u -+ d r, m/s: wheel speed at the start of the sample,
/// without the effect of the steering angle. s is constant over the sample.
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

/// Adds the accelerations by the external forces to `d`, the time derivatives of the state `at`.
template <class T>
State<T> with_push(State<T> d, const Plant<T>& plant, const ExternalForces<T>& push,
                   const State<T>& at) {
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

/// Time derivatives of the state of the 3-DOF plant, including external forces.
template <class T, class Forces>
State<T> pushed_rates(const Plant<T>& plant, const ExternalForces<T>& push, const State<T>& at,
                      const Forces& force, const T& steering_command_rad) {
  return with_push(state_rates(plant, at, force, steering_command_rad), plant, push, at);
}

/// Time derivatives of the state of a vehicle on tyres, including external forces.
template <class T, class Forces>
State<T> pushed_rates(const FourWheels<T>& vehicle, const ExternalForces<T>& push,
                      const State<T>& at, const Forces& force, const T& steering_command_rad) {
  return with_push(state_rates(vehicle, at, force, steering_command_rad), vehicle.body, push, at);
}

}  // namespace awmr
