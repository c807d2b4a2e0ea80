/// Check that the vehicle turns to the commanded heading. Freestanding C++14.
#pragma once

#include "awmr/control/motion_limits.h"
#include "awmr/control/sensor_fault.h"

namespace awmr {

/// Integral over the distance driven of the heading error beyond e0, m rad:
///   off = max(0, off + int (|psi_d - psi| - e0) |u| dt),  e0 = on_course_rad
/// It keeps growing while the vehicle does not turn to the commanded heading. Possible reasons: a
/// gyroscope with the wrong sign, a failed or reversed servo or motor, a target inside the turning
/// circle. A turn by 180 deg with the radius R adds
///   R int_e0^pi (e - e0) de = R (pi - e0)^2/2
class CourseCheck {
 public:
  void restart() { off_course_mrad_ = 0.0F; }

  /// Processes the motion up to a fix. True: the integral exceeds its limit. The integral restarts
  /// at 0 while the commanded speed is 0, and at a new command (kNewCourse_rad). `Limits`:
  /// GpsLimits, or a type with the same names as constants.
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
  /// The commanded heading counts as a new command if it changes by more than this, rad, between
  /// two fixes.
  static constexpr float kNewCourse_rad = 0.35F;

  float off_course_mrad_ = 0.0F;  // integral of the heading error beyond e0 over the distance
  float course_rad_ = 0.0F;       // commanded heading at the previous fix
};

}  // namespace awmr
