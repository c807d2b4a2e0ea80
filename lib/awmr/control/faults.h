/// Faults of a control step. Avoids names that Arduino defines as macros.
#pragma once

#include <stdint.h>

namespace awmr {

/// Reasons for the safe command (motors off, wheels straight). Several faults can occur at once, so
/// each fault is one bit. kFaultParameters lasts until the next start, every other fault as long as
/// its cause.
enum SafetyFault : uint8_t {
  kFaultNone = 0x00,
  kFaultParameters = 0x01,  ///< the parameters in flash have a wrong check sum
  kFaultNotFinite = 0x02,   ///< a measurement or the reference is infinite or NaN
  /// A measurement, the reference or the mode is out of range, or an input needs a part of the
  /// firmware that is not compiled in.
  kFaultRange = 0x04,
  kFaultHeadingStale = 0x08,    ///< heading and yaw rate were not updated in time
  kFaultSpeedStale = 0x10,      ///< speed (and position, if used) was not updated in time
  kFaultCommandTimeout = 0x20,  ///< the reference was not updated in time
  kFaultStepLate = 0x40,        ///< more time than permitted has passed since the last step
  kFaultOutput = 0x80           ///< the computed command was NaN or outside its limits
};

}  // namespace awmr
