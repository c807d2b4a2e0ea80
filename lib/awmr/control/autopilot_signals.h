/// Input and output of one autopilot step. Freestanding C++14.
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
  Position<float> position_m;   ///< world frame; used only if guidance or a flag below needs it
  Reference<float> reference;   ///< its heading is ignored while guidance is active
  InputTimes times;             ///< time stamps of all inputs
  /// Not 0: measured.u_mps is |u|, as from a GPS; its sign is computed (directed_speed.h).
  uint8_t speed_unsigned = 0;
  /// Not 0: position_m is the last fix of a receiver, taken at fix_ms, and the step estimates the
  /// present position (position_estimate.h). 0: position_m is the present position.
  uint8_t position_is_fix = 0;
  uint32_t fix_ms = 0;
};

/// Output of one step.
struct AutopilotOutput {
  Allocation<float> command;  ///< for the motors and the servo
  /// Output of the speed law minus the estimated disturbance, dimensionless, before any limit; 0 on
  /// a fault.
  float tau_speed;
  float tau_turn_m;   ///< like tau_speed, of the heading law: yaw moment over F_max, m
  float psi_ref_rad;  ///< heading reference of the law, rad; 0 on a fault
  bool arrived;       ///< the route is finished
  uint8_t fault;      ///< SafetyFault bits; not 0: `command` is the safe command
};

}  // namespace awmr
