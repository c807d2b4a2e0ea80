/// Inputs and limits of the checks of the motion between GPS fixes (motion_check.h).
#pragma once

#include "awmr/control/gps_sentence.h"

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

}  // namespace awmr
