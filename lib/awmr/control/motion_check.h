/// Comparison of the displacement between two GPS fixes with the speed, the command and the
/// heading.
/// Freestanding C++14.
#pragma once

#include "awmr/control/displacement.h"
#include "awmr/control/gps_sentence.h"
#include "awmr/control/sensor_fault.h"

namespace awmr {

/// The vehicle's command at the time of a fix.
struct GpsContext {
  float psi_rad;      ///< heading
  float psi_ref_rad;  ///< commanded heading
  int8_t direction;   ///< of the commanded speed: 1, 0 or -1
  /// False: a new position is accepted after ten fixes, 2 s at 5 Hz.
  bool is_armed;
};

/// Motion from one fix to the next.
struct GpsMotion {
  float dx_m, dy_m, time_s;
  float speed_mps;  ///< at its end, without a sign
};

/// Plausibility of the motion that fixes show. A fault lasts until restart().
class MotionCheck {
 public:
  void take(const GpsMotion& motion, const GpsContext& at) {
    motion_ = motion;
    context_ = at;
    due_ = Due::kDirection;
  }

  /// Compares the displacement of the last motion with the command (first call), with the speed
  /// (second) and with the heading (third), and the heading with the commanded one (fourth). False:
  /// done. `limits` as GpsLimits.
  template <class Limits>
  bool check(const Limits& limits) {
    switch (due_) {
      case Due::kDirection:
        due_ = motion_.time_s > kGap_s ? Due::kNothing : Due::kSpeed;
        if (due_ == Due::kNothing) {
          restart();
        } else {
          compare_with_direction();
        }
        break;
      case Due::kSpeed:
        due_ = Due::kTrack;
        compare_with_speed();
        measure_turn();
        break;
      case Due::kTrack:
        due_ = Due::kCourse;
        compare_with_heading();
        break;
      case Due::kCourse:
        due_ = Due::kNothing;
        compare_with_reference(limits);
        break;
      case Due::kNothing:
        break;
    }
    return due_ != Due::kNothing;
  }

  SensorFault fault() const { return fault_; }

  /// Clears the contradiction for the next arming.
  AWMR_CALLED_MEMBER void restart() {
    restart_window();
    same_m_ = against_m_ = 0.0F;
    against_fixes_ = 0;
    fault_ = kSensorGood;
    off_course_mrad_ = 0.0F;
    restart_track();
  }

 private:
  /// Next comparison of the last motion.
  enum class Due : uint8_t { kNothing, kDirection, kSpeed, kTrack, kCourse };

  /// Maximum gap between fixes across which motion is evaluated, s.
  static constexpr float kGap_s = 4.0F;
  /// Length of the windows in which displacement and speed are compared, m and s.
  static constexpr float kWindow_m = 12.0F;
  static constexpr float kWindow_s = 90.0F;
  /// Displacement along the heading that is permitted beyond 1.25 times the distance travelled, m.
  /// A
  /// position that wanders by 1.5 m RMS, correlated over a minute, drifts by
  ///   1.5 sqrt(2 (1 - exp(-t/60 s))) m RMS
  /// to one side in the time t: 1.9 m in a window.
  static constexpr float kFurther_m = 6.0F;
  /// Displacement along the heading that is required, as a share of the distance travelled. With a
  /// compass
  /// 30 deg off and three times that drift, a healthy vehicle reaches 0.39.
  static constexpr float kNotFurther = 0.25F;
  /// At u_ref = 0 a window is limited to this time, s, because the noise of an unsigned speed
  /// accumulates.
  static constexpr float kMoving_s = kWindow_m / kStandstill_mps;
  /// Maximum distance travelled without any change of position, m. With a commanded motion, the
  /// speed counts as at least kStill_mps (10 s), which detects a receiver that froze at rest.
  static constexpr float kSame_m = 1.5F;
  static constexpr float kStill_mps = 0.15F;
  /// Maximum displacement against the commanded direction, m, in as many consecutive fixes. At most
  /// kAhead_m of displacement ahead is deducted. It exceeds the drift of the position while the
  /// vehicle moves.
  static constexpr float kAgainst_m = 2.0F;
  static constexpr float kAhead_m = 1.0F;
  static constexpr uint8_t kAgainstFixes = 3;
  /// Track and heading are compared over this displacement, |ahead| + |left|: 10 m and 0.1 m/s.
  /// kOffTrack of it to the side is at least 3.5 times the drift (kFurther_m), also at low speed.
  static constexpr float kTrack_m = 10.0F;
  static constexpr float kTrack_mps = 0.1F;
  /// tan 30 deg: more than the sideslip of a vehicle plus the change of heading in 0.5 s of
  /// latency, in a turn of kStraight_rad per fix.
  static constexpr float kOffTrack = 0.577F;
  /// Displacements over which the heading changes by more than this, rad, are left out.
  static constexpr float kStraight_rad = 0.1F;
  /// A change of the commanded heading between two fixes by more than this, rad, is a new command.
  static constexpr float kNewCourse_rad = 0.35F;
  /// After a change of the commanded direction, longest time of braking, s, and largest increase of
  /// the speed, m/s.
  static constexpr float kBraking_s = 10.0F;
  static constexpr float kFaster_mps = 0.5F;

  GpsMotion motion_ = {0.0F, 0.0F, 0.0F, 0.0F};  // valid if a comparison is due
  GpsContext context_ = {0.0F, 0.0F, 0, false};
  float window_s_ = 0.0F;         // time since the window began
  float window_m_ = 0.0F;         // along the heading since then
  float window_left_m_ = 0.0F;    // to the left of it, where the motion is straight
  float travelled_m_ = 0.0F;      // integral of the speed since then
  float same_m_ = 0.0F;           // integral of the speed while the position did not change
  float against_m_ = 0.0F;        // against the commanded direction
  float ahead_m_ = 0.0F;          // of the last motion, valid from Due::kSpeed on
  float track_s_ = 0.0F;          // time of the motion since the track was compared
  float track_ahead_m_ = 0.0F;    // sum of ahead since then
  float track_left_m_ = 0.0F;     // sum of left
  float track_psi_rad_ = 0.0F;    // heading at the previous fix
  float off_course_mrad_ = 0.0F;  // integral of the heading difference over the distance
  float course_rad_ = 0.0F;       // commanded heading at the previous fix
  float braking_s_ = 0.0F;        // left of kBraking_s
  float braked_from_mps_ = 0.0F;  // speed when the commanded direction changed
  int8_t direction_ = 0;
  uint8_t against_fixes_ = 0;        // consecutive fixes beyond kAgainst_m
  SensorFault fault_ = kSensorGood;  // the first detected fault
  bool is_straight_ = false;         // the last motion, valid from Due::kTrack on
  Due due_ = Due::kNothing;

  AWMR_CALLED_MEMBER void note(SensorFault fault) {
    if (fault_ == kSensorGood) fault_ = fault;
  }

  AWMR_CALLED_MEMBER void restart_window() {
    window_s_ = window_m_ = window_left_m_ = travelled_m_ = 0.0F;
  }

  /// |int ahead| <= 1.25 int u dt + the drift since the window began, and at the end of a window
  /// that
  /// was driven one way
  ///   |int ahead| + |int left| >= 0.25 int u dt
  /// where left allows for a compass error (kOffHeading).
  AWMR_CALLED_MEMBER void compare_with_speed() {
    const bool is_long = travelled_m_ > kWindow_m;
    if (is_long && (direction_ != 0 || window_s_ < kMoving_s) &&
        detail::size_of(window_m_) + detail::size_of(window_left_m_) < kNotFurther * travelled_m_) {
      note(kGpsInconsistent);
    }
    if (is_long || window_s_ > kWindow_s || braking_s_ > 0.0F) restart_window();
    const float travelled_m = motion_.speed_mps * motion_.time_s;
    window_s_ += motion_.time_s;
    travelled_m_ += travelled_m;
    window_m_ += ahead_m_;
    if (detail::size_of(window_m_) > 1.25F * travelled_m_ + kFurther_m) {
      note(kGpsInconsistent);
    }
    if (motion_.dx_m != 0.0F || motion_.dy_m != 0.0F) same_m_ = 0.0F;
    if (motion_.speed_mps > kStandstill_mps) {
      same_m_ += travelled_m;
    } else if (direction_ != 0) {
      same_m_ += kStill_mps * motion_.time_s;
    }
    if (same_m_ > kSame_m) note(kGpsInconsistent);
  }

  /// Restarts when the commanded direction changes. A moving vehicle must brake first.
  void follow_command() {
    const bool is_moving = motion_.speed_mps > kStandstill_mps;
    if (context_.direction != direction_) {
      direction_ = context_.direction;
      braking_s_ = is_moving ? kBraking_s : 0.0F;
      braked_from_mps_ = motion_.speed_mps;
      against_m_ = 0.0F;
      against_fixes_ = 0;
      restart_window();
    }
    braking_s_ -= motion_.time_s;
    if (!is_moving || motion_.speed_mps > braked_from_mps_ + kFaster_mps) braking_s_ = 0.0F;
  }

  /// Checks the displacement against the commanded direction.
  AWMR_CALLED_MEMBER void compare_with_direction() {
    follow_command();
    ahead_m_ = displacement_ahead_m(motion_.dx_m, motion_.dy_m, context_.psi_rad);
    if (direction_ == 0) return;
    against_m_ -= direction_ > 0 ? ahead_m_ : -ahead_m_;
    if (against_m_ < -kAhead_m) {
      against_m_ = -kAhead_m;
      braking_s_ = 0.0F;
    }
    if (braking_s_ > 0.0F && against_m_ > 0.0F) against_m_ = 0.0F;
    against_fixes_ = against_m_ > kAgainst_m ? static_cast<uint8_t>(against_fixes_ + 1) : 0;
    if (against_fixes_ >= kAgainstFixes) note(kWrongWay);
  }

  AWMR_CALLED_MEMBER void restart_track() { track_s_ = track_ahead_m_ = track_left_m_ = 0.0F; }

  void measure_turn() {
    const float turned_rad = float_math::wrapped(context_.psi_rad - track_psi_rad_);
    track_psi_rad_ = context_.psi_rad;
    is_straight_ = !(detail::size_of(turned_rad) > kStraight_rad);
  }

  /// Compares the direction of the displacement with the heading: detects a compass that is mounted
  /// at an angle or deflected by iron.
  AWMR_CALLED_MEMBER void compare_with_heading() {
    if (direction_ == 0) return restart_track();
    if (!is_straight_) return;
    track_s_ += motion_.time_s;
    track_ahead_m_ += ahead_m_;
    const float moved_left_m = displacement_left_m(motion_.dx_m, motion_.dy_m, context_.psi_rad);
    track_left_m_ += moved_left_m;
    window_left_m_ += moved_left_m;
    const float ahead_m = detail::size_of(track_ahead_m_);
    const float left_m = detail::size_of(track_left_m_);
    if (ahead_m + left_m < kTrack_m + kTrack_mps * track_s_) return;
    if (left_m > kOffTrack * ahead_m) note(kOffHeading);
    restart_track();
  }

  /// Integral over the distance of the heading difference beyond e0, m rad:
  ///   off = max(0, off + int (|psi_d - psi| - e0) |u| dt),  e0 = on_course_rad
  /// It grows without limit if the vehicle does not turn to the commanded heading, for any reason:
  /// a gyroscope with the wrong sign, a failed or reversed servo or motor, a target inside the
  /// turning circle. A turn by 180 deg with the radius R adds
  ///   R int_e0^pi (e - e0) de = R (pi - e0)^2/2
  template <class Limits>
  AWMR_CALLED_MEMBER void compare_with_reference(const Limits& limits) {
    const float turned_rad = float_math::wrapped(context_.psi_ref_rad - course_rad_);
    course_rad_ = context_.psi_ref_rad;
    if (direction_ == 0 || detail::size_of(turned_rad) > kNewCourse_rad) {
      off_course_mrad_ = 0.0F;
      return;
    }
    const float error_rad = float_math::wrapped(context_.psi_ref_rad - context_.psi_rad);
    off_course_mrad_ +=
        (detail::size_of(error_rad) - limits.on_course_rad) * (motion_.speed_mps * motion_.time_s);
    if (off_course_mrad_ < 0.0F) off_course_mrad_ = 0.0F;
    if (off_course_mrad_ > limits.off_course_mrad) note(kOffCourse);
  }
};

}  // namespace awmr
