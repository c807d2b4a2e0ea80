/// Faults of compass, gyroscope and GPS: a sensor is believed only while it proves itself.
/// Freestanding C++14.
///
/// A sensor at fault is not believed, so that its time stamp ages and the autopilot gives the safe
/// command (safety.h); the SensorFault says why. A fault lasts as long as its cause and, for a
/// compass out of step and a displaced position, until the readings have agreed again for a while.
#pragma once

#include <stdint.h>

#include "awmr/model/float_math.h"

namespace awmr {

/// Why a sensor is not believed. The number is the code in messages and in the log.
enum SensorFault : uint8_t {
  kSensorGood = 0,
  kGyroSilent = 1,         ///< the gyroscope does not answer
  kGyroFrozen = 2,         ///< the same raw word for kFrozen_ms
  kGyroRange = 3,          ///< its range register is not what was set: it was reset
  kGyroNotCalibrated = 4,  ///< it has not been at rest long enough since the start
  kCompassSilent = 5,      ///< no new field for kCompassSilent_ms
  kCompassFrozen = 6,      ///< the same three raw words for kFrozen_ms
  kHeadingOutOfStep = 7,   ///< compass and gyroscope turn differently
  kGpsSilent = 8,          ///< no whole sentence for the time-out of the speed
  kGpsNoFix = 9,           ///< the receiver reports no fix, or fields are empty or damaged
  kGpsRepeated = 10,       ///< sentences come, their UTC stands still
  kGpsOld = 11,            ///< fixes lag behind by more than kGpsLag_ms, or their UTC runs back
  kGpsJump = 12,           ///< a displacement that the vehicle cannot drive
  kGpsInconsistent = 13,   ///< speed and displacement contradict each other
  kWrongWay = 14,          ///< driven one way, it moves the other
  kOffHeading = 15,        ///< the track of the positions is 30 deg and more off the heading
  kWrongTurn = 16          ///< the vehicle turns against the commanded yaw moment
};
constexpr uint8_t kSensorFaultCount = 17;

namespace detail {

/// Milliseconds from `then_ms` to `now_ms`, also across the clock's wrap.
inline uint32_t elapsed_ms(uint32_t now_ms, uint32_t then_ms) { return now_ms - then_ms; }

inline float size_of(float value) { return float_of(float_math::magnitude_bits(value)); }

}  // namespace detail

}  // namespace awmr
