/// Faults of compass, gyroscope and GPS: a reading is used only while it passes its checks.
/// Freestanding C++14.
///
/// Readings of a sensor with a fault are not used, so their time stamp ages and the autopilot gives
/// the safe command (safety.h). SensorFault is the reason. A fault lasts as long as its cause.
/// Faults of compass agreement and displaced position also last until the readings have agreed
/// again for a while.
#pragma once

#include <stdint.h>

#include "awmr/model/float_math.h"

namespace awmr {

/// Reason why a sensor is not used. The number is the code in messages and in the log.
enum SensorFault : uint8_t {
  kSensorGood = 0,
  kGyroSilent = 1,         ///< the gyroscope does not answer
  kGyroFrozen = 2,         ///< the same raw word for kFrozen_ms
  kGyroRange = 3,          ///< its range register was changed: the sensor was reset
  kGyroNotCalibrated = 4,  ///< not at rest long enough since the start
  kCompassSilent = 5,      ///< no new field for kCompassSilent_ms
  kCompassFrozen = 6,      ///< the same three raw words for kFrozen_ms
  kHeadingOutOfStep = 7,   ///< compass and gyroscope turn differently
  kGpsSilent = 8,          ///< no complete sentence within the time-out of the speed
  kGpsNoFix = 9,           ///< the receiver reports no fix, or fields are empty or damaged
  kGpsRepeated = 10,       ///< sentences arrive, but their UTC does not change
  kGpsOld = 11,            ///< fixes lag behind by more than kGpsLag_ms, or their UTC runs back
  kGpsJump = 12,           ///< a displacement that the vehicle cannot achieve
  kGpsInconsistent = 13,   ///< speed and displacement contradict each other
  kWrongWay = 14,          ///< moves against the commanded direction
  kOffHeading = 15,        ///< the track of the positions is 30 deg and more off the heading
  kWrongTurn = 16,         ///< the vehicle turns against the commanded yaw moment
  kOffCourse = 17          ///< does not turn to the commanded heading
};
constexpr uint8_t kSensorFaultCount = 18;

namespace detail {

/// Milliseconds from `then_ms` to `now_ms`, also across the clock's wrap.
inline uint32_t elapsed_ms(uint32_t now_ms, uint32_t then_ms) { return now_ms - then_ms; }

inline float size_of(float value) { return float_of(float_math::magnitude_bits(value)); }

}  // namespace detail

}  // namespace awmr
