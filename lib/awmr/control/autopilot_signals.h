/// Input and output of one autopilot step.
#pragma once

#include <stdint.h>

#include "awmr/control/allocation_limits.h"
#include "awmr/control/guidance/position.h"
#include "awmr/control/measurement.h"
#include "awmr/control/safety.h"

namespace awmr {

/// Input of one step.
struct AutopilotInput {
  uint8_t mode;                 ///< a YawMode
  Measurement<float> measured;  ///< motion of the vehicle from the sensors
  /// Position in the world frame. Used only by guidance, or if one of the flags below is set.
  Position<float> position_m;
  Reference<float> reference;  ///< desired motion; guidance, while active, replaces the heading
  InputTimes times;            ///< time stamps of all inputs
  /// Not 0: measured.u_mps is |u|, as from a GPS; its sign is computed (directed_speed.h).
  uint8_t speed_unsigned = 0;
  /// Not 0: position_m is the last fix of a GPS receiver, taken at fix_ms. The step then estimates
  /// the present position from it (position_estimate.h). 0: position_m is the present position.
  uint8_t position_is_fix = 0;
  uint32_t fix_ms = 0;
};

/// Output of one step.
struct AutopilotOutput {
  Allocation<float> command;  ///< for the motors and the servo
  /// Requested surge force, dimensionless, before any limit: output of the speed law minus the
  /// estimated disturbance. 0 on a fault.
  float tau_speed;
  /// Requested yaw moment divided by F_max, m, before any limit: output of the heading law minus
  /// the estimated disturbance. 0 on a fault.
  float tau_turn_m;
  float psi_ref_rad;  ///< desired heading, input of the heading law, rad; 0 on a fault
  bool arrived;       ///< the route is finished
  uint8_t fault;      ///< SafetyFault bits; if not 0, `command` is the safe command
};

}  // namespace awmr
