/// Inputs and limits of the checks of the motion between GPS fixes (motion_check.h). Freestanding
/// C++14.
#pragma once

#include "awmr/control/gps_sentence.h"

namespace awmr {

/// Heading and commands of the vehicle at the time of a GPS fix.
struct GpsContext {
  float psi_rad;      ///< heading
  float psi_ref_rad;  ///< commanded heading
  int8_t direction;   ///< sign of the commanded speed: 1, 0 or -1
  /// True: the vehicle is armed. A fix that it cannot have reached is then never accepted. In a
  /// vehicle that is not armed, the tenth of ten such fixes in a row is accepted (after 2 s at 5
  /// Hz).
  bool is_armed;
};

/// Displacement in the world frame, and time, from one GPS fix to the next.
struct GpsMotion {
  float dx_m, dy_m, time_s;
  float speed_mps;  ///< measured speed at the second fix, without a sign
};

/// Limits of the checks.
struct MotionLimits {
  /// Maximum time between two fixes, s, whose motion is checked. If the gap is longer, restart() is
  /// called, which also clears the fault.
  static constexpr float kGap_s = 4.0F;
  /// Displacement and measured speed are compared over a window. A window ends after this distance
  /// travelled, m, or after this time, s.
  static constexpr float kWindow_m = 12.0F;
  static constexpr float kWindow_s = 90.0F;
  /// Tolerance, m, of the displacement along the heading: it may exceed 1.25 times the distance
  /// travelled by this. The tolerance covers the drift of the fixes. An error of 1.5 m RMS with a
  /// correlation time of 60 s changes in the time t by
  ///   1.5 sqrt(2 (1 - exp(-t/60 s))) m RMS
  /// which is 1.9 m in a window of kWindow_s.
  static constexpr float kFurther_m = 6.0F;
  /// Smallest permitted displacement in a window, as a fraction of the distance travelled (integral
  /// of the measured speed). A healthy vehicle reaches 0.39 even with a compass error of 30 deg and
  /// three times the RMS drift of the fixes (see kFurther_m).
  static constexpr float kNotFurther = 0.25F;
  /// Longest window, s, in which displacement and measured speed are compared while the commanded
  /// speed is 0. In a longer window, the noise of a speed sensor without a sign can add up to
  /// kWindow_m.
  static constexpr float kMoving_s = kWindow_m / kStandstill_mps;
  /// Maximum integral of the measured speed while the position does not change, m. If a motion is
  /// commanded, a speed of at most kStandstill_mps counts as kStill_mps, m/s. So a receiver that
  /// froze while the vehicle was at rest is detected within 10 s.
  static constexpr float kSame_m = 1.5F;
  static constexpr float kStill_mps = 0.15F;
  /// Maximum displacement against the commanded direction, m. It is a fault if the displacement
  /// exceeds the maximum at kAgainstFixes consecutive fixes. An earlier displacement in the
  /// commanded direction is subtracted, but at most kAhead_m. The maximum exceeds the drift of the
  /// fixes during the motion.
  static constexpr float kAgainst_m = 2.0F;
  static constexpr float kAhead_m = 1.0F;
  static constexpr uint8_t kAgainstFixes = 3;
  /// The direction of travel is compared with the heading when the displacement |ahead| + |left|
  /// reaches kTrack_m plus kTrack_mps times the time. Then the smallest sideways displacement that
  /// is a fault (kOffTrack) is at least 3.5 times the RMS drift of the fixes (see kFurther_m), also
  /// at low speed.
  static constexpr float kTrack_m = 10.0F;
  static constexpr float kTrack_mps = 0.1F;
  /// Maximum ratio of the displacement to the left and the displacement ahead, |left|/|ahead|: tan
  /// 30 deg. The angle of 30 deg exceeds the sideslip of a vehicle plus the change of its heading
  /// during 0.5 s of latency in a turn by kStraight_rad per fix.
  static constexpr float kOffTrack = 0.577F;
  /// Motion is straight if the heading changes by at most this between two fixes, rad. Only in
  /// straight motion is the displacement compared with the heading.
  static constexpr float kStraight_rad = 0.1F;
  /// Time, s, after a change of the commanded direction, in which motion against the command counts
  /// as braking, not as a fault. This holds as long as the speed exceeds that at the change by at
  /// most kFaster_mps, m/s.
  static constexpr float kBraking_s = 10.0F;
  static constexpr float kFaster_mps = 0.5F;
};

}  // namespace awmr
