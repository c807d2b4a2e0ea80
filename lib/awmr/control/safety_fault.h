/// Faults of a control step. Freestanding C++14, and free of names that Arduino defines as macros.
#pragma once

#include <stdint.h>

namespace awmr {

/// Why the safe command was given: bits, as several faults may come at once. Only kFaultParameters
/// stays; the others last as long as their cause.
enum SafetyFault : uint8_t {
  kFaultNone = 0x00,
  kFaultParameters = 0x01,      ///< the parameters in flash are not those that were emitted
  kFaultNotFinite = 0x02,       ///< a measurement or a reference is infinite or NaN
  kFaultRange = 0x04,           ///< a measurement, a reference or the mode is out of range
  kFaultHeadingStale = 0x08,    ///< heading and yaw rate were not renewed in time
  kFaultSpeedStale = 0x10,      ///< speed (and position, where it is used) was not renewed in time
  kFaultCommandTimeout = 0x20,  ///< the reference was not renewed in time
  kFaultStepLate = 0x40,        ///< the step before was too long ago
  kFaultOutput = 0x80           ///< the command would have been no number or outside its limits
};

}  // namespace awmr
