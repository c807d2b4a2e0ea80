/// Check that the vehicle turns to the commanded heading.
#pragma once

#include "awmr/control/motion_limits.h"
#include "awmr/control/sensor_fault.h"

namespace awmr {

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

}  // namespace awmr
