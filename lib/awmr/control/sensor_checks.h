/// Plausibility checks of compass, gyroscope and GPS: a sensor is believed only while it proves
/// itself. State machines over raw readings with time stamps of one clock in ms that may wrap.
/// Freestanding C++14.
///
/// A sensor at fault is not believed, so that its time stamp ages and the autopilot gives the safe
/// command (safety.h); the SensorFault says why. A fault lasts as long as its cause and, for a
/// compass out of step and a displaced position, until the readings have agreed again for a while.
#pragma once

#include <stdint.h>

#include "awmr/control/displacement.h"
#include "awmr/control/gps_sentence.h"
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
  kWrongWay = 14           ///< driven one way, it moves the other
};

/// Raw words of a live sensor differ by noise: five counts RMS of the gyroscope, four of the compass.
/// 50 equal ones in a row are not of a live one.
constexpr uint32_t kFrozen_ms = 500;
constexpr uint32_t kCompassSilent_ms = 500;

namespace detail {

/// Milliseconds from `then_ms` to `now_ms`, also across the clock's wrap.
inline uint32_t elapsed_ms(uint32_t now_ms, uint32_t then_ms) { return now_ms - then_ms; }

inline float size_of(float value) { return float_of(float_math::magnitude_bits(value)); }

}  // namespace detail

/// Watches words that have to change.
class FrozenCheck {
 public:
  void take(uint32_t words, uint32_t now_ms) {
    if (!has_words_ || words != words_) {
      words_ = words;
      changed_ms_ = now_ms;
      has_words_ = true;
      is_frozen_ = false;
    } else if (detail::elapsed_ms(now_ms, changed_ms_) > kFrozen_ms) {
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

/// Zero-rate offset of a gyroscope, from one second at rest, tried again until it is at rest.
class GyroCalibration {
 public:
  /// Words of one sample time, at rest or not; `heading_rad` is the compass's, valid with
  /// `has_heading`.
  void take(int16_t word, float rate_per_word, bool has_heading, float heading_rad) {
    if (is_done_) return;
    if (count_ == 0) start(word);
    if (word < least_) least_ = word;
    if (word > most_) most_ = word;
    sum_ += word;
    ++count_;
    if (has_heading) take_heading(heading_rad);
    if (count_ < kSamples) return;
    bias_radps_ = static_cast<float>(sum_) * rate_per_word / static_cast<float>(kSamples);
    const float spread_radps =
        static_cast<float>(static_cast<int32_t>(most_) - least_) * rate_per_word;
    count_ = 0;
    is_done_ = spread_radps < kSpreadMax_radps && detail::size_of(bias_radps_) < kBiasMax_radps &&
               detail::size_of(turned_rad_) < kTurnMax_rad;
  }
  bool is_done() const { return is_done_; }
  float bias_radps() const { return bias_radps_; }

 private:
  static constexpr uint8_t kSamples = 100;
  /// Six times the peak-to-peak noise of an MPU9250 behind its 41 Hz filter.
  static constexpr float kSpreadMax_radps = 0.05F;
  /// The data sheet's zero-rate offset is 5 deg/s.
  static constexpr float kBiasMax_radps = 0.09F;
  /// Between the compass's first and last reading, rad: 3.4 deg, of which 1.4 deg may be noise.
  static constexpr float kTurnMax_rad = 0.06F;

  int32_t sum_ = 0;
  int16_t least_ = 0;
  int16_t most_ = 0;
  uint8_t count_ = 0;
  bool is_done_ = false;
  float bias_radps_ = 0.0F;
  float first_rad_ = 0.0F;
  float turned_rad_ = 0.0F;  // by the compass since its first reading
  bool has_first_ = false;

  void start(int16_t word) {
    sum_ = 0;
    least_ = most_ = word;
    turned_rad_ = 0.0F;
    has_first_ = false;
  }
  void take_heading(float heading_rad) {
    if (!has_first_) first_rad_ = heading_rad;
    has_first_ = true;
    turned_rad_ = float_math::wrapped(heading_rad - first_rad_);
  }
};

/// Compass against gyroscope. The heading is the integral of the gyroscope, led by the compass with
/// the time constant T; its innovation e = wrap(compass - heading) is T times the rate by which the
/// two differ.
class StepCheck {
 public:
  /// One innovation, `dt_s` after the last.
  void take(float innovation_rad, float dt_s) {
    slow_rad_ += dt_s * kSlow_per_s * (innovation_rad - slow_rad_);
    const float slow_rad = detail::size_of(slow_rad_);
    jumped_s_ = detail::size_of(innovation_rad) > kJump_rad ? jumped_s_ + dt_s : 0.0F;
    if (jumped_s_ > kJump_s || slow_rad > kSlowMax_rad) is_apart_ = true;
    if (jumped_s_ == 0.0F && slow_rad < 0.5F * kSlowMax_rad) is_apart_ = false;
  }
  bool is_apart() const { return is_apart_; }

 private:
  /// A jump of the compass, or a gyroscope with a wrong scale in a turn: 20 deg for 0.2 s.
  static constexpr float kJump_rad = 0.35F;
  static constexpr float kJump_s = 0.2F;
  /// A compass that stands still, or a gyroscope that drifts: 6 deg, with T = 2 s 3 deg/s, as a mean
  /// over 5 s.
  static constexpr float kSlow_per_s = 0.2F;
  static constexpr float kSlowMax_rad = 0.105F;

  float slow_rad_ = 0.0F;
  float jumped_s_ = 0.0F;
  bool is_apart_ = false;
};

/// Compass and gyroscope together.
class HeadingCheck {
 public:
  GyroCalibration calibration;
  StepCheck step;

  void begin(uint32_t now_ms) {
    gyro_ms_ = now_ms;
    field_ms_ = now_ms;
  }
  /// A word that the gyroscope gave.
  void take_gyro(int16_t word, uint32_t now_ms) {
    gyro_ms_ = now_ms;
    gyro_.take(static_cast<uint16_t>(word), now_ms);
  }
  /// Result of reading the range register back: true if it still holds the range that was set.
  void take_range(bool is_right) { is_range_wrong_ = !is_right; }
  /// A new field that the compass gave, as its three raw words.
  void take_field(int16_t x, int16_t y, int16_t z, uint32_t now_ms) {
    field_ms_ = now_ms;
    // One word of 32 bits in place of three of 16: what changes one of them changes it, but for
    // pairs of changes that cancel out, which are not all of those within half a second.
    const uint32_t low = static_cast<uint16_t>(x);
    const uint32_t high = static_cast<uint16_t>(y);
    field_.take(
        (low | high << 16U) ^ static_cast<uint32_t>(static_cast<uint16_t>(z)) * 0x9E3779B1UL,
        now_ms);
  }
  SensorFault fault(uint32_t now_ms) const {
    if (detail::elapsed_ms(now_ms, gyro_ms_) > kGyroSilent_ms) return kGyroSilent;
    if (is_range_wrong_) return kGyroRange;
    if (gyro_.is_frozen()) return kGyroFrozen;
    if (!calibration.is_done()) return kGyroNotCalibrated;
    if (detail::elapsed_ms(now_ms, field_ms_) > kCompassSilent_ms) return kCompassSilent;
    if (field_.is_frozen()) return kCompassFrozen;
    if (step.is_apart()) return kHeadingOutOfStep;
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

/// The vehicle's command at the time of a fix.
struct GpsContext {
  float psi_rad;     ///< heading
  int8_t direction;  ///< of the speed commanded: 1, 0 or -1
  /// False: a position elsewhere is taken over after ten fixes, 2 s at 5 Hz.
  bool is_armed;
};

/// Plausibility of GPS fixes.
class GpsCheck {
 public:
  /// m/s: the vehicle's largest speed. ms: how long no fix is missed.
  void begin(float speed_max_mps, uint32_t timeout_ms, uint32_t now_ms) {
    speed_max_mps_ = speed_max_mps;
    timeout_ms_ = timeout_ms;
    sentence_ms_ = now_ms;
  }

  /// A sentence without a usable fix.
  void take_unusable(GpsSentence kind, uint32_t now_ms) {
    if (kind == GpsSentence::kOther) return;
    sentence_ms_ = now_ms;
    last_ = kGpsNoFix;
  }

  /// A fix at (x, y), m, that came at `now_ms`. True: it is believed.
  bool take_fix(const GpsFix& fix, float x_m, float y_m, uint32_t now_ms, const GpsContext& at) {
    sentence_ms_ = now_ms;
    if (has_utc_) {
      const uint32_t advance_ms = (fix.utc_ms + kDay_ms - utc_ms_) % kDay_ms;
      if (advance_ms == 0) return refuse(kGpsRepeated);
      if (advance_ms > kDay_ms / 2) {
        unsettled_ = kRelocations;  // it ran back: believed again once it has advanced for a while
      } else {
        note_lag(detail::elapsed_ms(now_ms, utc_at_ms_), advance_ms);
      }
    }
    utc_ms_ = fix.utc_ms;
    utc_at_ms_ = now_ms;
    has_utc_ = true;
    if (lag_ms_ > kGpsLag_ms || unsettled_ > 0) {
      if (unsettled_ > 0) --unsettled_;
      return refuse(kGpsOld);
    }
    const Place here = {x_m, y_m, fix.speed_mps, now_ms};
    if (has_fix_ && !is_reachable(here, fix_)) {
      if (at.is_armed || ++elsewhere_ < kRelocations) return refuse(kGpsJump);
      restart_motion();
      has_fix_ = false;
    }
    // At rest after a contradiction: the next arming begins without it.
    if (!at.is_armed && fix.speed_mps < kStandstill_mps) restart_motion();
    note_motion(here, at);
    elsewhere_ = 0;
    fix_ = here;
    has_fix_ = true;
    last_ = kSensorGood;
    return true;
  }

  SensorFault fault(uint32_t now_ms) const {
    if (detail::elapsed_ms(now_ms, sentence_ms_) > timeout_ms_) return kGpsSilent;
    if (!has_fix_ || detail::elapsed_ms(now_ms, fix_.time_ms) > timeout_ms_) {
      return last_ != kSensorGood ? last_ : kGpsSilent;
    }
    if (is_wrong_way_) return kWrongWay;
    if (is_inconsistent_) return kGpsInconsistent;
    return kSensorGood;
  }

  /// Forgets what contradicted itself, for the next arming.
  void restart_motion() {
    against_m_ = moved_x_m_ = moved_y_m_ = travelled_m_ = 0.0F;
    same_m_ = 0.0F;
    is_wrong_way_ = is_inconsistent_ = false;
  }

 private:
  struct Place {
    float x_m, y_m, speed_mps;
    uint32_t time_ms;
  };

  /// Fixes may come so much later than the earliest of late, ms.
  static constexpr int32_t kGpsLag_ms = 500;
  /// Displacement between two fixes that is noise, m.
  static constexpr float kNoise_m = 3.0F;
  /// Fixes elsewhere, or of an earlier time, in a row before they are taken over.
  static constexpr uint8_t kRelocations = 10;
  /// Displacements are summed with this time constant, s.
  static constexpr float kMotion_s = 4.0F;
  /// So much of the way ahead is remembered, m: noise of the position against it.
  static constexpr float kAhead_m = 1.0F;
  /// So far against the commanded direction, m.
  static constexpr float kAgainst_m = 2.0F;
  /// So much further than its speed says, m, both axes together.
  static constexpr float kFurther_m = 3.0F;
  /// So far by its speed, m, on the very same position.
  static constexpr float kSame_m = 1.5F;

  float speed_max_mps_ = 0.0F;
  uint32_t timeout_ms_ = 0;
  uint32_t sentence_ms_ = 0;
  uint32_t utc_ms_ = 0;
  uint32_t utc_at_ms_ = 0;
  int32_t lag_ms_ = 0;
  Place fix_ = {0.0F, 0.0F, 0.0F, 0};          // the last that was believed
  float against_m_ = 0.0F;                     // against the commanded direction
  float moved_x_m_ = 0.0F, moved_y_m_ = 0.0F;  // net displacement
  float travelled_m_ = 0.0F;                   // integral of the speed
  float same_m_ = 0.0F;                        // the same while the position stood still
  uint8_t elsewhere_ = 0;                      // fixes that were too far away, in a row
  uint8_t unsettled_ = 0;                      // fixes to wait for after UTC ran back
  SensorFault last_ = kSensorGood;
  bool has_utc_ = false;
  bool has_fix_ = false;
  bool is_wrong_way_ = false;
  bool is_inconsistent_ = false;

  bool refuse(SensorFault why) {
    last_ = why;
    return false;
  }

  /// How far the fixes lag behind the earliest: it grows by what the clock went further than UTC
  /// did, and is forgiven a 64th of the time, as the clock of a board is off by up to 0.5 %.
  void note_lag(uint32_t wait_ms, uint32_t advance_ms) {
    lag_ms_ += static_cast<int32_t>(wait_ms - advance_ms) - static_cast<int32_t>(advance_ms / 64U);
    if (lag_ms_ < 0) lag_ms_ = 0;
  }

  /// Within 1.5 times the larger of both speeds and 1 m/s, and noise.
  bool is_reachable(const Place& to, const Place& from) const {
    const float dx = to.x_m - from.x_m;
    const float dy = to.y_m - from.y_m;
    const float time_s = 1e-3F * static_cast<float>(detail::elapsed_ms(to.time_ms, from.time_ms));
    float speed_mps = to.speed_mps > from.speed_mps ? to.speed_mps : from.speed_mps;
    if (speed_mps > speed_max_mps_) speed_mps = speed_max_mps_;
    const float reach_m = (1.5F * speed_mps + 1.0F) * time_s + kNoise_m;
    return dx * dx + dy * dy <= reach_m * reach_m;
  }
  void note_motion(const Place& to, const GpsContext& at) {
    if (!has_fix_) return;
    const float dt_s = 1e-3F * static_cast<float>(detail::elapsed_ms(to.time_ms, fix_.time_ms));
    if (dt_s > kMotion_s) return restart_motion();
    const float kept = 1.0F - dt_s / kMotion_s;
    const float dx = to.x_m - fix_.x_m;
    const float dy = to.y_m - fix_.y_m;
    moved_x_m_ = kept * moved_x_m_ + dx;
    moved_y_m_ = kept * moved_y_m_ + dy;
    travelled_m_ = kept * travelled_m_ + to.speed_mps * dt_s;
    const bool is_moving = to.speed_mps > kStandstill_mps;
    if (dx != 0.0F || dy != 0.0F) same_m_ = 0.0F;
    if (is_moving) same_m_ += to.speed_mps * dt_s;
    const float moved_m = detail::size_of(moved_x_m_) + detail::size_of(moved_y_m_);
    if (moved_m > 1.5F * travelled_m_ + kFurther_m || same_m_ > kSame_m) {
      is_inconsistent_ = true;
    }
    if (!is_moving || at.direction == 0) {
      against_m_ = 0.0F;
      return;
    }
    const float ahead_m = displacement_ahead_m(dx, dy, at.psi_rad);
    against_m_ = kept * against_m_ - (at.direction > 0 ? ahead_m : -ahead_m);
    if (against_m_ < -kAhead_m) against_m_ = -kAhead_m;
    if (against_m_ > kAgainst_m) is_wrong_way_ = true;
  }
};

}  // namespace awmr
