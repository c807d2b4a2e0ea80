/// Faults of a control step. Freestanding C++14, and free of names that Arduino defines as macros.
#pragma once

#include <stdint.h>

namespace awmr {

/// Reasons for the safe command, as bits, because several faults can occur together. Only
/// kFaultParameters is permanent; the others last as long as their cause.
enum SafetyFault : uint8_t {
  kFaultNone = 0x00,
  kFaultParameters = 0x01,      ///< the parameters in flash differ from those emitted
  kFaultNotFinite = 0x02,       ///< a measurement or the reference is infinite or NaN
  kFaultRange = 0x04,           ///< a measurement, the reference or the mode is out of range, or an
                                ///< input needs a part of the firmware that is not compiled in
  kFaultHeadingStale = 0x08,    ///< heading and yaw rate were not updated in time
  kFaultSpeedStale = 0x10,      ///< speed (and position, if used) was not updated in time
  kFaultCommandTimeout = 0x20,  ///< the reference was not updated in time
  kFaultStepLate = 0x40,        ///< the last step was too long ago
  kFaultOutput = 0x80           ///< the command would have been NaN or outside its limits
};

}  // namespace awmr
