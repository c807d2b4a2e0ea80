/// Motor commands that make the allocated forces, for motors with back-EMF and a dead zone.
#pragma once

#include "awmr/control/allocation_limits.h"
#include "awmr/model/resistance.h"
#include "awmr/model/scalar_math.h"
#include "awmr/model/state.h"

namespace awmr {

/// Constants of the allocation for motors with back-EMF at the speed u, m/s: each force limit is
/// reduced by k_e u, with the back-EMF coefficient k_e. In a turn, the speeds of the wheels differ
/// from u by -+ d r (d: half the track width, r: yaw rate). The limits here neglect this
/// difference; motor_drives() includes it.
template <class T>
AllocationConstants<T> at_speed(AllocationConstants<T> c, const T& back_emf_s_per_m, const T& u_mps,
                                double driven_wheels = 4.0) {
  using math::any;
  if (!any(back_emf_s_per_m > T(0.0))) return c;
  const T lost = back_emf_s_per_m * u_mps;
  c.tau_speed_min = c.tau_speed_min - T(driven_wheels) * lost;
  c.tau_speed_max = c.tau_speed_max - T(driven_wheels) * lost;
  c.force_min = c.force_min - lost;
  c.force_max = c.force_max - lost;
  return c;
}

/// Motor drives e, divided by F_max, that make the forces F' at the speed u, m/s, and the yaw rate
/// r, rad/s. A drive is the force that the motor would make at rest.
///   e = sat(F' + k_e w, [F'min, F'max]),   w = u -+ d r           upper sign: left, lower: right
/// k_e: back-EMF coefficient; d: half the track width. w is the speed of a rear wheel. The speed of
/// a front wheel differs by w d_r^2/2 and l_f r d_r, which are neglected. A drive of 0 switches the
/// motor off, and the wheel rolls freely. So motors that cannot reverse (F'min = 0) brake by
/// back-EMF only while the drive is above 0. NaN stays NaN.
template <class T>
SideForces<T> motor_drives(const SideForces<T>& force, const AllocationConstants<T>& c,
                           const T& back_emf_s_per_m, const T& u_mps, const T& r_radps) {
  using math::any;
  if (!any(back_emf_s_per_m > T(0.0))) return force;
  const T turn_mps = c.half_track_m * r_radps;
  return {
      math::clamp(T(force.left + back_emf_s_per_m * (u_mps - turn_mps)), c.force_min, c.force_max),
      math::clamp(T(force.right + back_emf_s_per_m * (u_mps + turn_mps)), c.force_min,
                  c.force_max)};
}

/// Motor commands, divided by F_max, that give these drives. The dead zone F'0 = `dead_zone`, which
/// the motor subtracts, is added to the magnitude of each drive other than 0.
template <class T>
SideForces<T> with_dead_zone(const SideForces<T>& drive, const T& dead_zone) {
  return {with_dead_zone(drive.left, dead_zone), with_dead_zone(drive.right, dead_zone)};
}

/// Motor commands, divided by F_max, that make these forces in spite of the motors' dead zone and
/// back-EMF.
template <class T>
SideForces<T> motor_commands(const SideForces<T>& force, const AllocationConstants<T>& c,
                             const T& dead_zone, const T& back_emf_s_per_m, const T& u_mps,
                             const T& r_radps) {
  return with_dead_zone(motor_drives(force, c, back_emf_s_per_m, u_mps, r_radps), dead_zone);
}

}  // namespace awmr
