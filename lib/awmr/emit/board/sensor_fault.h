/// Faults of compass, gyroscope and GPS. Avoids names that Arduino defines as macros.
///
/// While a sensor has a fault, its readings are not used. Their time stamp becomes too old, and the
/// autopilot outputs the safe command (control/safety.h). A fault usually ends with its cause. The
/// following faults end only under this condition:
///   kHeadingOutOfStep           compass and gyroscope have agreed again for a while
///   kWrongTurn                  the vehicle does not turn and its motors are off
///   kGpsOld                     if UTC ran backward: ten fixes with advancing UTC have arrived
///   kGpsJump                    a fix is within reach again; or the vehicle is disarmed and ten
///                               fixes in a row were out of reach: the tenth is accepted
///   kGpsInconsistent, kWrongWay, kOffHeading, kOffCourse
///                               the vehicle is disarmed and at rest; or a fix arrives after a gap
///                               of more than 4 s
#pragma once

#include <stdint.h>

#include "awmr/model/float_math.h"

namespace awmr {

/// Reason why a sensor is not used. Messages and the log give the number of the reason.
enum SensorFault : uint8_t {
  kSensorGood = 0,
  kGyroSilent = 1,         ///< the gyroscope does not answer
  kGyroFrozen = 2,         ///< the raw word of the gyroscope did not change for kFrozen_ms
  kGyroRange = 3,          ///< the range register of the gyroscope changed: the sensor was reset
  kGyroNotCalibrated = 4,  ///< the vehicle has not been at rest long enough since the start
  kCompassSilent = 5,      ///< no new magnetic field reading for kCompassSilent_ms
  kCompassFrozen = 6,      ///< the raw words of the compass did not change for kFrozen_ms
  kHeadingOutOfStep = 7,   ///< the compass and the integrated yaw rate disagree
  kGpsSilent = 8,          ///< no complete sentence within GpsLimits::timeout_ms
  kGpsNoFix = 9,           ///< the receiver reports no fix, or fields are empty or damaged
  kGpsRepeated = 10,       ///< sentences arrive, but their time (UTC) does not change
  /// The latency of the fixes exceeds its minimum by more than kGpsLag_ms, or UTC ran backward.
  kGpsOld = 11,
  kGpsJump = 12,          ///< a displacement larger than the vehicle can achieve
  kGpsInconsistent = 13,  ///< measured speed and displacement contradict each other
  kWrongWay = 14,         ///< the vehicle moves against the commanded direction of travel
  kOffHeading = 15,       ///< the direction of travel is 30 deg or more off the heading
  kWrongTurn = 16,        ///< the vehicle turns against the commanded yaw moment
  kOffCourse = 17         ///< the vehicle does not turn to the commanded heading
};
constexpr uint8_t kSensorFaultCount = 18;

namespace detail {

/// Magnitude |value|. Arduino defines abs as a macro.
inline float size_of(float value) { return float_of(float_math::magnitude_bits(value)); }

}  // namespace detail

}  // namespace awmr
