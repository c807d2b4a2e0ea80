/// Plausibility checks of the motion from one GPS fix to the next: they compare the displacement
/// with the measured speed, the commanded direction and the heading, and the heading with the
/// commanded heading.
#pragma once

#include "awmr/control/displacement.h"
#include "awmr/control/measurement.h"
#include "awmr/emit/board/gps_sentence.h"
#include "awmr/emit/board/sensor_fault.h"

namespace awmr {

/// Heading and commands of the vehicle at the time of a GPS fix.
struct GpsContext {
  float psi_rad;      ///< heading
  float psi_ref_rad;  ///< commanded heading
  int8_t direction;   ///< sign of the commanded speed: 1, 0 or -1
  /// True: the vehicle is armed. A fix that it cannot have reached is then never accepted. A
  /// disarmed vehicle accepts the tenth of ten such fixes in a row (after 2 s at 5 Hz).
  bool is_armed;
};

/// Displacement in the world frame, and time, from one GPS fix to the next.
struct GpsMotion {
  float dx_m, dy_m, time_s;
  float speed_mps;  ///< measured speed at the second fix, without a sign
};

/// Limits of MotionCheck.
struct MotionLimits {
  /// Maximum time between two fixes, s, whose motion is checked. After a longer gap, restart() is
  /// called, which also clears the fault.
  static constexpr float kGap_s = 4.0F;
  /// Displacement and measured speed are compared over a window. The window ends after this
  /// distance travelled, m, or after this time, s.
  static constexpr float kWindow_m = 12.0F;
  static constexpr float kWindow_s = 90.0F;
  /// Tolerance of the displacement along the heading, m: it may exceed 1.25 times the distance
  /// travelled by this. The tolerance covers the drift of the fixes. With an error of 1.5 m RMS and
  /// a correlation time of 60 s, a fix drifts in the time t by
  ///   1.5 sqrt(2 (1 - exp(-t/60 s))) m RMS
  /// which is 1.9 m in a window of kWindow_s.
  static constexpr float kFurther_m = 6.0F;
  /// Smallest permitted displacement in a window, as a fraction of the distance travelled. A
  /// healthy vehicle reaches 0.39 even with a compass error of 30 deg and three times the RMS drift
  /// of the fixes (kFurther_m).
  static constexpr float kNotFurther = 0.25F;
  /// Longest window, s, in which displacement and measured speed are compared while the commanded
  /// speed is 0. In a longer window, the noise of an unsigned speed sensor alone can add up to
  /// kWindow_m.
  static constexpr float kMoving_s = kWindow_m / kStandstill_mps;
  /// Maximum integral of the measured speed while the position does not change, m. If motion is
  /// commanded, a speed of at most kStandstill_mps counts as kStill_mps, m/s. By this rule, a
  /// receiver whose readings stopped changing while the vehicle was at rest is detected within 10
  /// s; without it, it would never be detected.
  static constexpr float kSame_m = 1.5F;
  static constexpr float kStill_mps = 0.15F;
  /// Maximum displacement against the commanded direction, m: more than the drift of the fixes
  /// during the motion. A larger displacement at kAgainstFixes consecutive fixes is a fault. An
  /// earlier displacement in the commanded direction is subtracted, but at most kAhead_m.
  static constexpr float kAgainst_m = 2.0F;
  static constexpr float kAhead_m = 1.0F;
  static constexpr uint8_t kAgainstFixes = 3;
  /// The direction of travel is compared with the heading when the displacement |ahead| + |left|
  /// reaches kTrack_m plus kTrack_mps times the time. At any speed, the smallest sideways
  /// displacement that is a fault (kOffTrack) is then at least 3.5 times the RMS drift of the fixes
  /// (kFurther_m).
  static constexpr float kTrack_m = 10.0F;
  static constexpr float kTrack_mps = 0.1F;
  /// Maximum of |left|/|ahead|, the ratio of the displacements to the left and ahead: tan 30 deg.
  /// The angle of 30 deg exceeds the sideslip of a vehicle plus its turn during 0.5 s of latency,
  /// at kStraight_rad per fix.
  static constexpr float kOffTrack = 0.577F;
  /// Largest change of the heading between two fixes, rad, at which a motion counts as straight.
  /// Only straight motion is compared with the heading.
  static constexpr float kStraight_rad = 0.1F;
  /// Time after a change of the commanded direction, s, in which motion against the command counts
  /// as braking and not as a fault. If the speed rises by more than kFaster_mps, m/s, above its
  /// value at the change, this time ends at once.
  static constexpr float kBraking_s = 10.0F;
  static constexpr float kFaster_mps = 0.5F;
};

/// Integral of the heading error beyond e0 = on_course_rad over the distance driven, m rad:
///   off = max(0, off + int (|psi_d - psi| - e0) |u| dt)
/// psi_d is the commanded heading, psi the heading, u the speed. The integral grows as long as the
/// vehicle does not turn to psi_d, because the gyroscope has the wrong sign, a servo or motor
/// failed or is reversed, or the target is inside the turning circle. A turn by 180 deg with the
/// radius R, without a failure, adds only
///   R int_e0^pi (e - e0) de = R (pi - e0)^2/2
class CourseCheck {
 public:
  void restart() { off_course_mrad_ = 0.0F; }

  /// Processes the motion from the previous fix to this one. Returns true if the integral exceeds
  /// its limit. The integral restarts at 0 while the commanded speed is 0, and at each new heading
  /// command. `Limits`: GpsLimits, or a type with constants of the same names.
  template <class Limits>
  AWMR_CALLED_MEMBER bool is_off(const Limits& limits, const GpsMotion& motion,
                                 const GpsContext& at) {
    const float turned_rad = float_math::wrapped(at.psi_ref_rad - course_rad_);
    course_rad_ = at.psi_ref_rad;
    if (at.direction == 0 || detail::size_of(turned_rad) > kNewCourse_rad) {
      off_course_mrad_ = 0.0F;
      return false;
    }
    const float error_rad = float_math::wrapped(at.psi_ref_rad - at.psi_rad);
    off_course_mrad_ +=
        (detail::size_of(error_rad) - limits.on_course_rad) * (motion.speed_mps * motion.time_s);
    if (off_course_mrad_ < 0.0F) off_course_mrad_ = 0.0F;
    return off_course_mrad_ > limits.off_course_mrad;
  }

 private:
  /// A change of the commanded heading by more than this between two fixes, rad, is a new heading
  /// command.
  static constexpr float kNewCourse_rad = 0.35F;

  float off_course_mrad_ = 0.0F;  // heading error beyond e0, integrated over the distance
  float course_rad_ = 0.0F;       // commanded heading at the previous fix
};

/// Checks of the motion between GPS fixes. A fault lasts until restart().
class MotionCheck : MotionLimits {
 public:
  /// Stores a motion from one fix to the next. check() then makes its four comparisons.
  void take(const GpsMotion& motion, const GpsContext& at) {
    motion_ = motion;
    context_ = at;
    due_ = Due::kDirection;
  }

  /// Makes the next of four comparisons for the last motion: 1. displacement with commanded
  /// direction, 2. displacement with measured speed, 3. displacement with heading, 4. heading with
  /// commanded heading. Returns false once all four are done. `Limits`: GpsLimits, or a type with
  /// constants of the same names.
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
        if (course_.is_off(limits, motion_, context_)) note(kOffCourse);
        break;
      case Due::kNothing:
        break;
    }
    return due_ != Due::kNothing;
  }

  /// Returns the first fault since restart(); kSensorGood: none.
  SensorFault fault() const { return fault_; }

  /// Clears the fault and all sums, so that the vehicle can be armed again.
  AWMR_CALLED_MEMBER void restart() {
    restart_window();
    same_m_ = against_m_ = 0.0F;
    against_fixes_ = 0;
    fault_ = kSensorGood;
    course_.restart();
    restart_track();
  }

 private:
  /// Next comparison of the last motion.
  enum class Due : uint8_t { kNothing, kDirection, kSpeed, kTrack, kCourse };

  GpsMotion motion_ = {0.0F, 0.0F, 0.0F, 0.0F};  // valid if a comparison is due
  GpsContext context_ = {0.0F, 0.0F, 0, false};
  CourseCheck course_;
  float window_s_ = 0.0F;       // time since the window began
  float window_m_ = 0.0F;       // displacement along the heading in the window
  float window_left_m_ = 0.0F;  // displacement to the left in the window, in straight motion
  float travelled_m_ = 0.0F;    // integral of the speed in the window
  float same_m_ = 0.0F;         // integral of the speed since the position last changed
  float against_m_ = 0.0F;      // displacement against the commanded direction of travel
  float ahead_m_ = 0.0F;        // displacement along the heading since the previous fix
  // Time in straight motion since the last comparison of displacement and heading.
  float track_s_ = 0.0F;
  float track_ahead_m_ = 0.0F;       // displacement along the heading in this time
  float track_left_m_ = 0.0F;        // displacement to the left of the heading in this time
  float track_psi_rad_ = 0.0F;       // heading at the previous fix
  float braking_s_ = 0.0F;           // time left for braking
  float braked_from_mps_ = 0.0F;     // measured speed when the commanded direction changed
  int8_t direction_ = 0;             // commanded direction at the last fix (GpsContext::direction)
  uint8_t against_fixes_ = 0;        // consecutive fixes with against_m_ above kAgainst_m
  SensorFault fault_ = kSensorGood;  // the first detected fault
  // the motion to the last fix was straight; valid from Due::kTrack on
  bool is_straight_ = false;
  Due due_ = Due::kNothing;

  AWMR_CALLED_MEMBER void note(SensorFault fault) {
    if (fault_ == kSensorGood) fault_ = fault;
  }

  AWMR_CALLED_MEMBER void restart_window() {
    window_s_ = window_m_ = window_left_m_ = travelled_m_ = 0.0F;
  }

  /// Compares the displacement with the distance travelled, which is the integral of the measured
  /// speed u. Both are summed over a window of time. `ahead` and `left` are the displacements along
  /// the heading and to its left. A motion without fault satisfies, at every fix,
  ///   |sum of ahead| <= 1.25 int |u| dt + kFurther_m
  /// and, at the end of a window with int |u| dt > kWindow_m,
  ///   |sum of ahead| + |sum of left| >= 0.25 int |u| dt
  /// While the commanded speed is 0, the second line is tested only in windows shorter than
  /// kMoving_s. It contains the sum of left so that a compass error is reported as kOffHeading and
  /// not here.
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

  /// Restarts the sums of displacements when the commanded direction of travel changes. If the
  /// vehicle is moving then, it has kBraking_s to brake.
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

  /// Compares the displacement with the commanded direction of travel: a vehicle that moves the
  /// opposite way has a fault.
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

  /// Compares the direction of the displacement with the heading. Detects a compass that is mounted
  /// at an angle or deflected by iron nearby.
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
};

}  // namespace awmr
