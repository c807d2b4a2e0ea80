/// Optional part of a firmware: compensation of the motors' dead zone and back-EMF, and of friction
/// that jumps at rest.
#pragma once

#include <stdint.h>

#include "awmr/control/allocation_limits.h"
#include "awmr/control/controller.h"
#include "awmr/control/flash.h"
#include "awmr/control/measurement.h"
#include "awmr/control/motor_command.h"
#include "awmr/control/optional_part.h"
#include "awmr/control/parameters_block.h"
#include "awmr/control/speed_law.h"

namespace awmr {

/// Increases the motor commands to compensate the dead zone and the back-EMF of the motors.
struct MotorCurve {
  float dead_zone;         ///< dead zone F'0 of a motor, divided by F_max; 0: none
  float back_emf_s_per_m;  ///< k_e of a motor, s/m; 0: none
  /// Parameters of this part, in flash on an AVR. Null: no dead zone, no back-EMF and no friction
  /// that jumps at rest.
  const RestBlock* rest;
  uint8_t mode;  ///< YawMode to which the friction width of the yaw resistance g3 is set

  void start(const RestBlock* block) {
    rest = block;
    mode = 0;  // start_autopilot() sets the yaw resistance g3 for this mode
    dead_zone = rest != 0 ? flash_float(&rest->dead_zone) : 0.0F;
    back_emf_s_per_m = rest != 0 ? flash_float(&rest->back_emf_s_per_m) : 0.0F;
  }
};

/// Replaces each force by the motor command that makes this force in spite of the dead zone. No-op
/// if MotorCurve is not compiled in.
AWMR_INLINE void make_up_dead_zone(const Disabled<MotorCurve>&, SideForces<float>&) {}
inline void make_up_dead_zone(const MotorCurve& part, SideForces<float>& force) {
  force = with_dead_zone(force, part.dead_zone);
}

/// Sets the friction width of the yaw resistance g3 to the width of `mode`, if the mode has
/// changed. Below this yaw rate, the feed-forward of Coulomb friction changes smoothly with the yaw
/// rate instead of jumping (Gains::friction_width_at()). No-op if MotorCurve is not compiled in.
template <class G>
AWMR_INLINE void use_friction_width(Disabled<MotorCurve>&, uint8_t, G&) {}
template <class G>
void use_friction_width(MotorCurve& part, uint8_t mode, G& yaw) {
  if (mode == part.mode) return;
  part.mode = mode;
  if (part.rest != 0) set_friction_width(part.rest, mode, yaw);
}

/// Returns the speed whose back-EMF the motor commands make up, m/s: made_up_speed(), or the
/// measured speed if MotorCurve is not compiled in.
template <class G>
AWMR_INLINE float back_emf_speed(const Disabled<MotorCurve>&, const PreparedController<float, G>&,
                                 const Measurement<float>& m, const Reference<float>&) {
  return m.u_mps;
}
template <class G>
AWMR_INLINE float back_emf_speed(const MotorCurve& part, const PreparedController<float, G>& c,
                                 const Measurement<float>& m, const Reference<float>& ref) {
  if (!(part.back_emf_s_per_m > 0.0F)) return m.u_mps;
  return made_up_speed(c.constants.laws, m.u_mps, ref.speed_mps);
}

/// Returns the allocation limits at the speed u, m/s: the limits at rest, `c`, reduced by back-EMF
/// if MotorCurve is compiled in.
AWMR_INLINE const AllocationConstants<float>& limits_at(const Disabled<MotorCurve>&,
                                                        const AllocationConstants<float>& c,
                                                        const float& /*u_mps*/) {
  return c;
}
inline AllocationConstants<float> limits_at(const MotorCurve& part,
                                            const AllocationConstants<float>& c,
                                            const float& u_mps) {
  return at_speed(c, part.back_emf_s_per_m, u_mps);
}

/// Replaces each force by the motor drive that makes this force in spite of the back-EMF. No-op if
/// MotorCurve is not compiled in.
AWMR_INLINE void make_up_back_emf(const Disabled<MotorCurve>&, const AllocationConstants<float>&,
                                  float /*u_mps*/, float /*r_radps*/, SideForces<float>&) {}
inline void make_up_back_emf(const MotorCurve& part, const AllocationConstants<float>& c,
                             float u_mps, float r_radps, SideForces<float>& force) {
  force = motor_drives(force, c, part.back_emf_s_per_m, u_mps, r_radps);
}

}  // namespace awmr
