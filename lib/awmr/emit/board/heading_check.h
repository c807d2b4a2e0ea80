/// Plausibility checks of the raw readings of compass and gyroscope. All time stamps are readings
/// of one clock, in ms, that can wrap to 0.
#pragma once

#include "awmr/emit/board/gyro_calibration.h"
#include "awmr/emit/board/sensor_fault.h"

namespace awmr {

/// A sensor counts as frozen if its raw word has not changed for this time, ms: 50 readings at 100
/// Hz. In a working sensor, noise changes the word continually, by 5 counts RMS (gyroscope) or 4
/// counts RMS (compass).
constexpr uint32_t kFrozen_ms = 500;
/// Longest permitted time between two readings of the compass, ms.
constexpr uint32_t kCompassSilent_ms = 500;

/// Detects a sensor whose raw word has not changed for kFrozen_ms.
class FrozenCheck {
 public:
  /// Processes the raw word `words`, read at the time `now_ms`.
  AWMR_CALLED_MEMBER void take(uint32_t words, uint32_t now_ms) {
    if (!has_words_ || words != words_) {
      words_ = words;
      changed_ms_ = now_ms;
      has_words_ = true;
      is_frozen_ = false;
    } else if (now_ms - changed_ms_ > kFrozen_ms) {
      is_frozen_ = true;
    }
  }
  bool is_frozen() const { return is_frozen_; }

 private:
  uint32_t words_ = 0;
  uint32_t changed_ms_ = 0;
  bool has_words_ = false;
  bool is_frozen_ = false;
};

/// Compares compass and gyroscope. The heading is the integral of the gyroscope's yaw rate,
/// corrected by the compass with the time constant T. The innovation e = wrap(compass - heading) is
/// the difference that the compass corrects. In the steady state, e is T times the difference
/// between the yaw rates of the two sensors.
class StepCheck {
 public:
  /// Processes one innovation e, rad. `dt_s` is the time since the previous one.
  void take(float innovation_rad, float dt_s) {
    slow_rad_ += dt_s * kSlow_per_s * (innovation_rad - slow_rad_);
    const float slow_rad = detail::size_of(slow_rad_);
    jumped_s_ = detail::size_of(innovation_rad) > kJump_rad ? jumped_s_ + dt_s : 0.0F;
    if (jumped_s_ > kJump_s || slow_rad > kSlowMax_rad) is_apart_ = true;
    if (jumped_s_ == 0.0F && slow_rad < 0.5F * kSlowMax_rad) is_apart_ = false;
  }
  bool is_apart() const { return is_apart_; }

 private:
  /// Limits of a sudden fault: the innovation exceeds 20 deg for 0.2 s. Causes: the compass jumped,
  /// or the scale of the gyroscope is wrong and the vehicle turns.
  static constexpr float kJump_rad = 0.35F;
  static constexpr float kJump_s = 0.2F;
  /// Limits of a slow fault: the innovation, after a low pass of 5 s, exceeds 6 deg. With the time
  /// constant T = 2 s, this is a difference of 3 deg/s between the two yaw rates. Causes: the
  /// compass is frozen, or the gyroscope drifts.
  static constexpr float kSlow_per_s = 0.2F;
  static constexpr float kSlowMax_rad = 0.105F;

  float slow_rad_ = 0.0F;
  float jumped_s_ = 0.0F;
  bool is_apart_ = false;
};

/// Compares the yaw rate with the commanded yaw moment. Detects swapped left and right motors, a
/// reversed servo, and a gyroscope with the wrong sign. A fault: the vehicle turns by 90 deg
/// against the commanded moment, while its yaw rate stays above three quarters of the largest yaw
/// rate of this turn. (If the yaw rate falls, the moment brakes an earlier turn, which is no
/// fault.)
class TurnCheck {
 public:
  /// Sets the scale. `rate_per_word`: rad/s per count of the gyroscope. `dt_s`: time between two
  /// readings, s.
  void begin(float rate_per_word, float dt_s) {
    quarter_turn_words_ = static_cast<int32_t>(float_math::kPiBy2 / (rate_per_word * dt_s));
  }
  /// Processes a reading of the gyroscope without its zero-rate offset. `moment_m`: yaw moment
  /// commanded since the last reading, divided by F_max, m; 0: the motors are off. Uses integers,
  /// which are fast on the chip.
  AWMR_CALLED_MEMBER void take(int16_t word, float moment_m) {
    if (word <= kTurning && word >= -kTurning) {
      if (is_wrong_ && float_math::magnitude_bits(moment_m) == 0) restart();
      return;
    }
    if (float_math::magnitude_bits(moment_m) == 0) return;
    const uint16_t size = static_cast<uint16_t>(word < 0 ? -static_cast<int32_t>(word) : word);
    if ((word < 0) == (bits_of(moment_m) >> 31U != 0) || size < fastest_ - fastest_ / 4U) {
      against_words_ = 0;
      fastest_ = size;
      return;
    }
    if (size > fastest_) fastest_ = size;
    against_words_ += size;
    is_wrong_ = is_wrong_ || against_words_ > quarter_turn_words_;
    if (is_wrong_) against_words_ = 0;
  }
  bool is_wrong() const { return is_wrong_; }

 private:
  /// Smallest |word| that counts as turning: 5.7 deg/s for an MPU9250 with the range +-500 deg/s,
  /// which is above its noise.
  static constexpr int16_t kTurning = 375;
  int32_t quarter_turn_words_ = 0;  // sum of the words during a turn of 90 deg
  int32_t against_words_ = 0;       // sum of |word| while turning against the moment
  uint16_t fastest_ = 0;            // largest |word| since against_words_ was 0
  bool is_wrong_ = false;

  void restart() {
    against_words_ = 0;
    fastest_ = 0;
    is_wrong_ = false;
  }
};

/// All checks of compass and gyroscope together.
class HeadingCheck {
 public:
  GyroCalibration calibration;
  StepCheck step;
  TurnCheck turn;

  void begin(uint32_t now_ms) {
    gyro_ms_ = now_ms;
    field_ms_ = now_ms;
  }
  /// Processes a raw reading of the gyroscope, read at the time `now_ms`.
  void take_gyro(int16_t word, uint32_t now_ms) {
    gyro_ms_ = now_ms;
    gyro_.take(static_cast<uint16_t>(word), now_ms);
  }
  /// Processes a check of the gyroscope's range register. `is_right` false: the register has lost
  /// the range that was set at the start, because the sensor was reset.
  void take_range(bool is_right) { is_range_wrong_ = !is_right; }
  /// Processes a new reading of the compass: three raw words of the magnetic field.
  void take_field(int16_t x, int16_t y, int16_t z, uint32_t now_ms) {
    field_ms_ = now_ms;
    // Combine the three 16-bit words into one 32-bit word. In a single reading, changes of two
    // words can cancel each other, but not in every reading of half a second.
    const uint32_t low = static_cast<uint16_t>(x);
    const uint32_t high = static_cast<uint16_t>(y);
    field_.take(
        (low | high << 16U) ^ static_cast<uint32_t>(static_cast<uint16_t>(z)) * 0x9E3779B1UL,
        now_ms);
  }
  /// Returns the first fault that is found by the tests below, in their order; kSensorGood: none.
  SensorFault fault(uint32_t now_ms) const {
    if (now_ms - gyro_ms_ > kGyroSilent_ms) return kGyroSilent;
    if (is_range_wrong_) return kGyroRange;
    if (gyro_.is_frozen()) return kGyroFrozen;
    if (!calibration.is_done()) return kGyroNotCalibrated;
    if (now_ms - field_ms_ > kCompassSilent_ms) return kCompassSilent;
    if (field_.is_frozen()) return kCompassFrozen;
    if (step.is_apart()) return kHeadingOutOfStep;
    if (turn.is_wrong()) return kWrongTurn;
    return kSensorGood;
  }

 private:
  static constexpr uint32_t kGyroSilent_ms = 100;
  FrozenCheck gyro_;
  FrozenCheck field_;
  uint32_t gyro_ms_ = 0;
  uint32_t field_ms_ = 0;
  bool is_range_wrong_ = false;
};

}  // namespace awmr
