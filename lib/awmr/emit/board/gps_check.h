/// Plausibility checks of GPS fixes. All time stamps are readings of one clock, in ms, that can
/// wrap to 0.
#pragma once

#include "awmr/emit/board/motion_check.h"

namespace awmr {

/// Bounds that a healthy vehicle and its GPS do not exceed.
struct GpsLimits {
  float speed_max_mps;  ///< largest speed
  float on_course_rad;  ///< e0: largest heading error of a healthy vehicle in steady motion
  /// largest integral of (heading error - e0) over the distance driven, m rad
  float off_course_mrad;
  uint32_t timeout_ms;  ///< longest time without a fix
  /// True: the work on a fix is spread over several control steps (GpsReceiver).
  static constexpr bool spreads_work = true;
};

/// Checks whether GPS fixes are plausible. `Limits`: GpsLimits, or a type with constants of the
/// same names.
template <class Limits = GpsLimits>
class GpsCheck {
 public:
  constexpr explicit GpsCheck(const Limits& limits = Limits()) : limits_(limits) {}

  /// Starts the time-out for the first GPS sentence.
  void begin(uint32_t now_ms) { sentence_ms_ = now_ms; }

  /// Processes a GPS sentence that contains no usable fix. Sentences other than RMC are ignored.
  void take_unusable(GpsSentence kind, uint32_t now_ms) {
    if (kind == GpsSentence::kOther) return;
    sentence_ms_ = now_ms;
    last_ = kGpsNoFix;
  }

  /// Processes a fix at (x, y), m, received at `now_ms`. Returns true if the fix is accepted.
  bool take_fix(const GpsFix& fix, float x_m, float y_m, uint32_t now_ms, const GpsContext& at) {
    const bool is_believed = accept_fix(fix, x_m, y_m, now_ms, at);
    finish_motion();
    return is_believed;
  }

  /// First part of take_fix(): decides whether to accept the fix. The second part, check_motion(),
  /// can follow in later steps, but must be done before the next fix.
  bool accept_fix(const GpsFix& fix, float x_m, float y_m, uint32_t now_ms, const GpsContext& at) {
    sentence_ms_ = now_ms;
    if (has_utc_) {
      // utc_ms is a time of day, which starts at 0 again at midnight.
      uint32_t advance_ms = fix.utc_ms - utc_ms_;
      if (fix.utc_ms < utc_ms_) advance_ms += kDay_ms;
      if (advance_ms == 0) return refuse(kGpsRepeated);
      if (advance_ms > kDay_ms / 2) {
        // UTC ran backward: refuse fixes until UTC has advanced for a while.
        unsettled_ = kRelocations;
      } else {
        note_lag(now_ms - utc_at_ms_, advance_ms);
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
    const GpsMotion motion = motion_to(here);
    if (has_fix_ && !is_reachable(here, motion)) {
      if (at.is_armed || ++elsewhere_ < kRelocations) return refuse(kGpsJump);
      motion_.restart();
      has_fix_ = false;
    }
    // The vehicle is disarmed and at rest: clear the faults of the motion checks. Otherwise, it
    // could not be armed again.
    if (!at.is_armed && fix.speed_mps < kStandstill_mps) motion_.restart();
    elsewhere_ = 0;
    if (has_fix_) motion_.take(motion, at);
    fix_ = here;
    has_fix_ = true;
    last_ = kSensorGood;
    return true;
  }

  /// Makes the next comparison of MotionCheck::check() for the last accepted fix. Returns false
  /// once all comparisons are done.
  bool check_motion() { return motion_.check(limits_); }
  void finish_motion() {
    while (check_motion()) {
    }
  }

  /// Returns the reason why the GPS must not be used; kSensorGood: the GPS can be used.
  SensorFault fault(uint32_t now_ms) const {
    if (now_ms - sentence_ms_ > limits_.timeout_ms) return kGpsSilent;
    if (!has_fix_ || now_ms - fix_.time_ms > limits_.timeout_ms) {
      return last_ != kSensorGood ? last_ : kGpsSilent;
    }
    return motion_.fault();
  }

 private:
  struct Place {
    float x_m, y_m, speed_mps;
    uint32_t time_ms;
  };

  /// Largest permitted increase of the latency of a fix over the smallest latency so far, ms. A fix
  /// with a larger latency is refused as kGpsOld.
  static constexpr int32_t kGpsLag_ms = 500;
  /// Displacement that the noise of two fixes can cause, m.
  static constexpr float kNoise_m = 3.0F;
  /// Number of fixes out of reach in a row that a disarmed vehicle must receive: the last of them
  /// is accepted as its new position, as after a transport. Also the number of fixes that must
  /// arrive after UTC ran backward: the last of them is accepted.
  static constexpr uint8_t kRelocations = 10;

  Limits limits_;
  uint32_t sentence_ms_ = 0;
  uint32_t utc_ms_ = 0;
  uint32_t utc_at_ms_ = 0;
  int32_t lag_ms_ = 0;
  Place fix_ = {0.0F, 0.0F, 0.0F, 0};  // last accepted fix
  MotionCheck motion_;
  uint8_t elsewhere_ = 0;  // consecutive fixes that the vehicle cannot have reached
  uint8_t unsettled_ = 0;  // fixes that are still refused because UTC ran backward
  SensorFault last_ = kSensorGood;
  bool has_utc_ = false;
  bool has_fix_ = false;

  bool refuse(SensorFault why) {
    last_ = why;
    return false;
  }

  /// Updates lag_ms_, the latency of the last fix minus the smallest latency so far. From one fix
  /// to the next, the latency grows by the advance of the board's clock minus the advance of UTC.
  /// The board's clock can be wrong by up to 0.5 %. So 1/64 of the time (1.6 %) is subtracted.
  /// Without this, a slow drift of the board's clock would look like a growing latency.
  void note_lag(uint32_t wait_ms, uint32_t advance_ms) {
    lag_ms_ += static_cast<int32_t>(wait_ms - advance_ms) - static_cast<int32_t>(advance_ms / 64U);
    if (lag_ms_ < 0) lag_ms_ = 0;
  }

  /// Displacement and time from the last accepted fix to the place `to`.
  GpsMotion motion_to(const Place& to) const {
    return {to.x_m - fix_.x_m, to.y_m - fix_.y_m,
            1e-3F * static_cast<float>(to.time_ms - fix_.time_ms), to.speed_mps};
  }

  /// True if the vehicle can have moved from the last accepted fix to the place `to`. The
  /// displacement is then at most
  ///   kNoise_m + (1.5 u + 1 m/s) t
  /// u is the larger of the speeds at the two fixes, t the time between them.
  bool is_reachable(const Place& to, const GpsMotion& motion) const {
    float speed_mps = to.speed_mps > fix_.speed_mps ? to.speed_mps : fix_.speed_mps;
    if (speed_mps > limits_.speed_max_mps) speed_mps = limits_.speed_max_mps;
    const float reach_m = (1.5F * speed_mps + 1.0F) * motion.time_s + kNoise_m;
    return motion.dx_m * motion.dx_m + motion.dy_m * motion.dy_m <= reach_m * reach_m;
  }
};

}  // namespace awmr
