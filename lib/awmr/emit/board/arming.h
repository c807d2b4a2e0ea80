/// Arming: the motors can turn only after the command ARM and until the first reason to stop.
///
/// After a reset, the vehicle is disarmed. ARM is refused while any fault other than the command
/// time-out is present. STOP, a command time-out, any fault and the end of a route disarm the
/// vehicle. It stays disarmed until the next ARM, even if the reason has ended.
#pragma once

#include <stdint.h>

#include "awmr/control/faults.h"

namespace awmr {

/// Why the vehicle is disarmed.
enum class DisarmReason : uint8_t {
  kNone = 0,     ///< the vehicle is armed
  kReset = 1,    ///< not armed since the start
  kStop = 2,     ///< the command STOP
  kTimeout = 3,  ///< no valid command arrived for AWMR_COMMAND_TIMEOUT_MS
  kFault = 4,    ///< a fault disarmed the vehicle; `fault` and `cause` give it
  kArrived = 5   ///< the route is finished
};

struct Arming {
  DisarmReason reason = DisarmReason::kReset;
  uint8_t fault = kFaultNone;  ///< SafetyFault bits that disarmed the vehicle
  uint8_t cause = 0;           ///< SensorFault that disarmed the vehicle; 0: none

  bool is_armed() const { return reason == DisarmReason::kNone; }

  /// Arms the vehicle and returns true. If the last step had a sensor fault, or a fault other than
  /// the command time-out, changes nothing and returns false.
  bool arm(uint8_t step_fault, uint8_t sensor_fault) {
    if ((step_fault & ~static_cast<unsigned>(kFaultCommandTimeout)) != 0 || sensor_fault != 0) {
      return false;
    }
    reason = DisarmReason::kNone;
    fault = kFaultNone;
    cause = 0;
    return true;
  }
  /// Disarms the vehicle and stores the reason. If the vehicle is already disarmed, it keeps the
  /// first reason, unless the new reason is kStop.
  void disarm(DisarmReason why) {
    if (is_armed() || why == DisarmReason::kStop) reason = why;
  }
  /// Disarms the vehicle if the last step had any fault. Call it after each step. Returns true if
  /// this call disarmed the vehicle.
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
