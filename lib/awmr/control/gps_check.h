/// Plausibility checks of GPS fixes: a state machine with time stamps of one clock in ms that can
/// wrap. Freestanding C++14.
#pragma once

#include "awmr/control/displacement.h"
#include "awmr/control/gps_sentence.h"
#include "awmr/control/sensor_fault.h"

namespace awmr {

/// The vehicle's command at the time of a fix.
struct GpsContext {
  float psi_rad;      ///< heading
  float psi_ref_rad;  ///< heading that is to be held
  int8_t direction;   ///< of the commanded speed: 1, 0 or -1
  /// False: a position elsewhere is accepted after ten fixes, 2 s at 5 Hz.
  bool is_armed;
};

/// Plausibility of GPS fixes.
class GpsCheck {
 public:
  /// speed_max_mps: the vehicle's largest speed. off_course_mrad: distance driven off the wanted heading
  /// before a fault, m rad. timeout_ms: time without a fix before a fault.
  void begin(float speed_max_mps, float off_course_mrad, uint32_t timeout_ms, uint32_t now_ms) {
    speed_max_mps_ = speed_max_mps;
    off_course_max_mrad_ = off_course_mrad;
    timeout_ms_ = timeout_ms;
    sentence_ms_ = now_ms;
  }

  /// Processes a sentence without a usable fix.
  void take_unusable(GpsSentence kind, uint32_t now_ms) {
    if (kind == GpsSentence::kOther) return;
    sentence_ms_ = now_ms;
    last_ = kGpsNoFix;
  }

  /// Processes a fix at (x, y), m, received at `now_ms`. True: it is accepted.
  bool take_fix(const GpsFix& fix, float x_m, float y_m, uint32_t now_ms, const GpsContext& at) {
    const bool is_believed = accept_fix(fix, x_m, y_m, now_ms, at);
    finish_motion();
    return is_believed;
  }

  /// First part of take_fix(): decides whether to accept the fix. check_motion() can do the rest in
  /// later steps, before the next fix.
  bool accept_fix(const GpsFix& fix, float x_m, float y_m, uint32_t now_ms, const GpsContext& at) {
    sentence_ms_ = now_ms;
    if (has_utc_) {
      // Both are times of day.
      uint32_t advance_ms = fix.utc_ms - utc_ms_;
      if (fix.utc_ms < utc_ms_) advance_ms += kDay_ms;
      if (advance_ms == 0) return refuse(kGpsRepeated);
      if (advance_ms > kDay_ms / 2) {
        unsettled_ = kRelocations;  // UTC ran back: wait until it has advanced for a while
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
    const Motion motion = motion_to(here);
    if (has_fix_ && !is_reachable(here, motion)) {
      if (at.is_armed || ++elsewhere_ < kRelocations) return refuse(kGpsJump);
      restart_motion();
      has_fix_ = false;
    }
    // At rest after a contradiction: reset for the next arming.
    if (!at.is_armed && fix.speed_mps < kStandstill_mps) restart_motion();
    elsewhere_ = 0;
    if (has_fix_) {
      move_anchor(now_ms);
      motion_ = motion;
      context_ = at;
      due_ = Due::kSpeed;
    }
    fix_ = here;
    has_fix_ = true;
    last_ = kSensorGood;
    return true;
  }

  /// Compares the displacement of the last fix that was believed, at the first call with its speed, at
  /// the second with the command, at the third with the heading; at the fourth the heading with that
  /// which is to be held. False: that is done.
  bool check_motion() {
    switch (due_) {
      case Due::kSpeed:
        due_ = motion_.time_s > kGap_s ? Due::kNothing : Due::kDirection;
        if (due_ == Due::kNothing) {
          restart_motion();
        } else {
          compare_with_speed();
        }
        break;
      case Due::kDirection:
        due_ = Due::kTrack;
        compare_with_direction();
        break;
      case Due::kTrack:
        due_ = Due::kCourse;
        compare_with_heading();
        break;
      case Due::kCourse:
        due_ = Due::kNothing;
        compare_with_reference();
        break;
      case Due::kNothing:
        break;
    }
    return due_ != Due::kNothing;
  }
  void finish_motion() {
    while (check_motion()) {
    }
  }

  SensorFault fault(uint32_t now_ms) const {
    if (detail::elapsed_ms(now_ms, sentence_ms_) > timeout_ms_) return kGpsSilent;
    if (!has_fix_ || detail::elapsed_ms(now_ms, fix_.time_ms) > timeout_ms_) {
      return last_ != kSensorGood ? last_ : kGpsSilent;
    }
    return motion_fault_;
  }

  /// Clears the contradiction for the next arming.
  AWMR_CALLED void restart_motion() {
    has_anchor_ = false;
    same_m_ = against_m_ = 0.0F;
    against_fixes_ = 0;
    motion_fault_ = kSensorGood;
    off_course_mrad_ = 0.0F;
    restart_track();
  }

 private:
  struct Place {
    float x_m, y_m, speed_mps;
    uint32_t time_ms;
  };
  struct Motion {
    float dx_m, dy_m, time_s;
  };
  /// What is left to compare the last motion with.
  enum class Due : uint8_t { kNothing, kSpeed, kDirection, kTrack, kCourse };

  /// Maximum lag of fixes behind the earliest, ms.
  static constexpr int32_t kGpsLag_ms = 500;
  /// Displacement between two fixes that counts as noise, m.
  static constexpr float kNoise_m = 3.0F;
  /// Number of consecutive fixes elsewhere, or with an earlier time, before they are accepted.
  static constexpr uint8_t kRelocations = 10;
  /// Maximum gap between fixes across which motion is evaluated, s.
  static constexpr float kGap_s = 4.0F;
  /// Length of the windows in which displacement and speed are compared, m and ms.
  static constexpr float kWindow_m = 20.0F;
  static constexpr uint32_t kWindow_ms = 30000;
  /// Permitted displacement beyond 1.5 times the distance travelled, m: the drift of the position
  /// in a window.
  static constexpr float kFurther_m = 3.0F;
  /// Maximum distance travelled without any change of position, m.
  static constexpr float kSame_m = 1.5F;
  /// Maximum displacement against the commanded direction, m, in as many consecutive fixes. At most
  /// kAhead_m of displacement ahead is deducted. It exceeds the drift of the position while the
  /// vehicle moves.
  static constexpr float kAgainst_m = 2.0F;
  static constexpr float kAhead_m = 1.0F;
  static constexpr uint8_t kAgainstFixes = 3;
  /// Track and heading are compared over this displacement, |ahead| + |left|, m: three times what a
  /// position wanders to the side meanwhile.
  static constexpr float kTrack_m = 10.0F;
  /// tan 30 deg: beyond the sideslip of a vehicle, and a heading 0.5 s older than the position in a turn of
  /// kStraight_rad a fix.
  static constexpr float kOffTrack = 0.577F;
  /// Displacements over which the heading changes by more than this, rad, are left out.
  static constexpr float kStraight_rad = 0.1F;
  /// Largest difference of heading and wanted heading of a vehicle on its course, rad: pi/4, more than
  /// gusts, slopes and unequal motors cause.
  static constexpr float kOnCourse_rad = 0.785F;
  /// A change of the wanted heading between two fixes by more than this, rad, is a new one.
  static constexpr float kNewCourse_rad = 0.35F;
  /// After a change of the commanded direction the vehicle brakes for at most this long, s, and gets
  /// faster by no more than this, m/s.
  static constexpr float kBraking_s = 10.0F;
  static constexpr float kFaster_mps = 0.5F;

  float speed_max_mps_ = 0.0F;
  float off_course_max_mrad_ = 0.0F;
  uint32_t timeout_ms_ = 0;
  uint32_t sentence_ms_ = 0;
  uint32_t utc_ms_ = 0;
  uint32_t utc_at_ms_ = 0;
  int32_t lag_ms_ = 0;
  Place fix_ = {0.0F, 0.0F, 0.0F, 0};   // last accepted fix
  Motion motion_ = {0.0F, 0.0F, 0.0F};  // displacement to it, valid if one is due
  GpsContext context_ = {0.0F, 0.0F, 0, false};
  Place anchor_ = {0.0F, 0.0F, 0.0F, 0};  // where the window began, valid with has_anchor_
  float travelled_m_ = 0.0F;              // integral of the speed since then
  float same_m_ = 0.0F;                   // integral of the speed while the position stood still
  float against_m_ = 0.0F;                // against the commanded direction
  float ahead_m_ = 0.0F;                  // of the last motion, valid with Due::kTrack
  float track_ahead_m_ = 0.0F;            // sum of ahead since the track was compared
  float track_left_m_ = 0.0F;             // sum of left
  float track_psi_rad_ = 0.0F;            // heading at the fix before
  float off_course_mrad_ = 0.0F;          // distance driven off the wanted heading
  float course_rad_ = 0.0F;               // wanted heading at the fix before
  float braking_s_ = 0.0F;                // left of kBraking_s
  float braked_from_mps_ = 0.0F;          // speed when the commanded direction changed
  int8_t direction_ = 0;
  uint8_t against_fixes_ = 0;  // consecutive fixes beyond kAgainst_m
  uint8_t elsewhere_ = 0;      // consecutive fixes that were too far away
  uint8_t unsettled_ = 0;      // fixes to wait for after UTC ran back
  SensorFault last_ = kSensorGood;
  SensorFault motion_fault_ = kSensorGood;  // the first that the motion showed
  bool has_utc_ = false;
  bool has_fix_ = false;
  bool has_anchor_ = false;
  Due due_ = Due::kNothing;

  bool refuse(SensorFault why) {
    last_ = why;
    return false;
  }

  void note_motion_fault(SensorFault fault) {
    if (motion_fault_ == kSensorGood) motion_fault_ = fault;
  }

  /// Updates the lag of the fixes behind the earliest. It grows by the advance of the clock minus
  /// that of UTC, and decreases by 1/64 of the time, because a board's clock can be wrong by up to
  /// 0.5 %.
  void note_lag(uint32_t wait_ms, uint32_t advance_ms) {
    lag_ms_ += static_cast<int32_t>(wait_ms - advance_ms) - static_cast<int32_t>(advance_ms / 64U);
    if (lag_ms_ < 0) lag_ms_ = 0;
  }

  /// Displacement and time from the last accepted fix to this one.
  Motion motion_to(const Place& to) const {
    return {to.x_m - fix_.x_m, to.y_m - fix_.y_m,
            1e-3F * static_cast<float>(detail::elapsed_ms(to.time_ms, fix_.time_ms))};
  }

  /// True within noise plus 1.5 times the larger of both speeds and 1 m/s.
  bool is_reachable(const Place& to, const Motion& motion) const {
    float speed_mps = to.speed_mps > fix_.speed_mps ? to.speed_mps : fix_.speed_mps;
    if (speed_mps > speed_max_mps_) speed_mps = speed_max_mps_;
    const float reach_m = (1.5F * speed_mps + 1.0F) * motion.time_s + kNoise_m;
    return motion.dx_m * motion.dx_m + motion.dy_m * motion.dy_m <= reach_m * reach_m;
  }

  /// Starts a window at the last accepted fix if there is none or the last window is complete.
  void move_anchor(uint32_t now_ms) {
    if (has_anchor_ && !(travelled_m_ > kWindow_m) &&
        detail::elapsed_ms(now_ms, anchor_.time_ms) <= kWindow_ms) {
      return;
    }
    anchor_ = fix_;
    travelled_m_ = 0.0F;
    has_anchor_ = true;
  }

  /// |dx| + |dy| <= 1.5 int u dt + the drift since the anchor, because |dx| + |dy| <= sqrt(2) int u
  /// dt.
  void compare_with_speed() {
    const bool is_moving = fix_.speed_mps > kStandstill_mps;
    follow_command(is_moving);
    const float travelled_m = fix_.speed_mps * motion_.time_s;
    if (motion_.dx_m != 0.0F || motion_.dy_m != 0.0F) same_m_ = 0.0F;
    if (is_moving) same_m_ += travelled_m;
    if (same_m_ > kSame_m) note_motion_fault(kGpsInconsistent);
    travelled_m_ += travelled_m;
    const float moved_m =
        detail::size_of(fix_.x_m - anchor_.x_m) + detail::size_of(fix_.y_m - anchor_.y_m);
    if (moved_m > 1.5F * travelled_m_ + kFurther_m) note_motion_fault(kGpsInconsistent);
  }

  /// Restarts when the commanded direction changes. A moving vehicle must brake first.
  void follow_command(bool is_moving) {
    if (context_.direction != direction_) {
      direction_ = context_.direction;
      braking_s_ = is_moving ? kBraking_s : 0.0F;
      braked_from_mps_ = fix_.speed_mps;
      against_m_ = 0.0F;
      against_fixes_ = 0;
    }
    braking_s_ -= motion_.time_s;
    if (!is_moving || fix_.speed_mps > braked_from_mps_ + kFaster_mps) braking_s_ = 0.0F;
  }

  /// Checks the displacement against the commanded direction.
  void compare_with_direction() {
    if (direction_ == 0) return;
    ahead_m_ = displacement_ahead_m(motion_.dx_m, motion_.dy_m, context_.psi_rad);
    against_m_ -= direction_ > 0 ? ahead_m_ : -ahead_m_;
    if (against_m_ < -kAhead_m) {
      against_m_ = -kAhead_m;
      braking_s_ = 0.0F;
    }
    if (braking_s_ > 0.0F && against_m_ > 0.0F) against_m_ = 0.0F;
    against_fixes_ = against_m_ > kAgainst_m ? static_cast<uint8_t>(against_fixes_ + 1) : 0;
    if (against_fixes_ >= kAgainstFixes) note_motion_fault(kWrongWay);
  }

  void restart_track() { track_ahead_m_ = track_left_m_ = 0.0F; }

  /// The direction of the displacement beside the heading: a compass that is turned on the vehicle, or
  /// that iron turns, leads it off its course.
  void compare_with_heading() {
    const float turned_rad = float_math::wrapped(context_.psi_rad - track_psi_rad_);
    track_psi_rad_ = context_.psi_rad;
    if (direction_ == 0) return restart_track();
    if (detail::size_of(turned_rad) > kStraight_rad) return;
    track_ahead_m_ += ahead_m_;
    track_left_m_ += displacement_left_m(motion_.dx_m, motion_.dy_m, context_.psi_rad);
    const float ahead_m = detail::size_of(track_ahead_m_);
    const float left_m = detail::size_of(track_left_m_);
    if (ahead_m + left_m < kTrack_m) return;
    if (left_m > kOffTrack * ahead_m) note_motion_fault(kOffHeading);
    restart_track();
  }

  /// Distance driven at a heading that is off the wanted one, m rad:
  ///   off = max(0, off + int (|psi_d - psi| - pi/4) |u| dt)
  /// It grows without end where the vehicle does not turn to where it is to head, whatever the reason: a
  /// gyroscope of the wrong sign, a servo or motor that has failed, a point inside of the turning
  /// circle. A turn by 180 deg with the radius R takes
  ///   R int_(pi/4)^pi (e - pi/4) de = 2.8 R
  void compare_with_reference() {
    const float turned_rad = float_math::wrapped(context_.psi_ref_rad - course_rad_);
    course_rad_ = context_.psi_ref_rad;
    if (direction_ == 0 || detail::size_of(turned_rad) > kNewCourse_rad) {
      off_course_mrad_ = 0.0F;
      return;
    }
    const float error_rad = float_math::wrapped(context_.psi_ref_rad - context_.psi_rad);
    off_course_mrad_ +=
        (detail::size_of(error_rad) - kOnCourse_rad) * (fix_.speed_mps * motion_.time_s);
    if (off_course_mrad_ < 0.0F) off_course_mrad_ = 0.0F;
    if (off_course_mrad_ > off_course_max_mrad_) note_motion_fault(kOffCourse);
  }
};

}  // namespace awmr
