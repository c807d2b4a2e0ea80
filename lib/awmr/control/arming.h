/// Arming: motors turn only between an arm command and the first reason to stop. Freestanding C++14.
///
/// Disarmed is the state after a reset. ARM is refused while a sensor is at fault. Everything that
/// ends a drive disarms and latches: STOP, a time-out of the commands, any fault, the end of a route.
#pragma once

#include <stdint.h>

#include "awmr/control/safety_fault.h"

namespace awmr {

/// Why the vehicle is disarmed.
enum class DisarmReason : uint8_t {
  kNone = 0,     ///< it is armed
  kReset = 1,    ///< nobody has armed it since the start
  kStop = 2,     ///< the command STOP
  kTimeout = 3,  ///< no valid command for AWMR_COMMAND_TIMEOUT_MS
  kFault = 4,    ///< a fault; `fault` and `cause` keep which
  kArrived = 5   ///< nothing is left to go to
};

struct Arming {
  DisarmReason reason = DisarmReason::kReset;
  uint8_t fault = kFaultNone;  ///< SafetyFault bits that disarmed it
  uint8_t cause = 0;           ///< SensorFault that disarmed it; 0: none

  bool is_armed() const { return reason == DisarmReason::kNone; }

  /// `fault` and `cause` are those of the last step. False: refused, the vehicle stays as it is.
  bool arm(uint8_t step_fault, uint8_t sensor_fault) {
    if ((step_fault & ~static_cast<unsigned>(kFaultCommandTimeout)) != 0 || sensor_fault != 0) {
      return false;
    }
    reason = DisarmReason::kNone;
    fault = kFaultNone;
    cause = 0;
    return true;
  }
  void disarm(DisarmReason why) {
    if (is_armed() || why == DisarmReason::kStop) reason = why;
  }
  /// After each step: any fault disarms. True: this step did.
  bool observe(uint8_t step_fault, uint8_t sensor_fault) {
    if (!is_armed() || (step_fault == kFaultNone && sensor_fault == 0)) return false;
    const bool is_silence = step_fault == kFaultCommandTimeout && sensor_fault == 0;
    reason = is_silence ? DisarmReason::kTimeout : DisarmReason::kFault;
    fault = step_fault;
    cause = sensor_fault;
    return true;
  }
};

}  // namespace awmr
