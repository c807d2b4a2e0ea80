/// Inputs and limits of the checks of the motion between GPS fixes (motion_check.h). Freestanding
/// C++14.
#pragma once

#include "awmr/control/gps_sentence.h"

namespace awmr {

/// Heading and command of the vehicle at the time of a fix.
struct GpsContext {
  float psi_rad;      ///< heading
  float psi_ref_rad;  ///< commanded heading
  int8_t direction;   ///< sign of the commanded speed: 1, 0 or -1
  /// True: the vehicle is armed, and a fix that it cannot have reached is never accepted. False: of
  /// ten such fixes in a row (2 s at 5 Hz), the tenth is accepted.
  bool is_armed;
};

/// Displacement in the world frame and time from one fix to the next.
struct GpsMotion {
  float dx_m, dy_m, time_s;
  float speed_mps;  ///< measured speed at the second fix, without a sign
};

/// Limits of the checks.
struct MotionLimits {
  /// Maximum time between two fixes whose motion is evaluated, s. The first fix after a longer gap
  /// calls restart(), which also clears the fault.
  static constexpr float kGap_s = 4.0F;
  /// A window in which displacement and measured speed are compared ends after this distance
  /// travelled, m, or after this time, s.
  static constexpr float kWindow_m = 12.0F;
  static constexpr float kWindow_s = 90.0F;
  /// Displacement along the heading that is permitted in addition to 1.25 times the distance
  /// travelled, m. It covers the drift of the fixes: an error of 1.5 m RMS with a correlation time
  /// of 60 s changes in the time t by
  ///   1.5 sqrt(2 (1 - exp(-t/60 s))) m RMS
  /// which is 1.9 m in a window of kWindow_s.
  static constexpr float kFurther_m = 6.0F;
  /// Displacement that is required in a window, as a fraction of the distance travelled (integral
  /// of the measured speed). A healthy vehicle reaches 0.39 even with a compass error of 30 deg and
  /// three times the RMS drift above.
  static constexpr float kNotFurther = 0.25F;
  /// Longest window, s, in which displacement and measured speed are compared at u_ref = 0. In a
  /// longer window, the noise of the unsigned speed alone can add up to kWindow_m.
  static constexpr float kMoving_s = kWindow_m / kStandstill_mps;
  /// Maximum integral of the measured speed while the position does not change, m. While a motion
  /// is commanded, a speed of at most kStandstill_mps counts as kStill_mps, m/s, so that a receiver
  /// that froze at rest is detected within 10 s.
  static constexpr float kSame_m = 1.5F;
  static constexpr float kStill_mps = 0.15F;
  /// Maximum displacement against the commanded direction, m: a fault if kAgainstFixes consecutive
  /// fixes exceed it. An earlier displacement in the commanded direction is subtracted, but at most
  /// kAhead_m. The maximum is larger than the drift of the fixes while the vehicle moves.
  static constexpr float kAgainst_m = 2.0F;
  static constexpr float kAhead_m = 1.0F;
  static constexpr uint8_t kAgainstFixes = 3;
  /// The direction of travel is compared with the heading after a displacement |ahead| + |left| of
  /// kTrack_m plus kTrack_mps times the time. A sideways displacement that is a fault (kOffTrack)
  /// is then at least 3.5 times the RMS drift of the fixes (see kFurther_m), at low speed too.
  static constexpr float kTrack_m = 10.0F;
  static constexpr float kTrack_mps = 0.1F;
  /// Maximum |left|/|ahead| of the displacement: tan 30 deg. This angle exceeds the sideslip of a
  /// vehicle plus the change of heading in 0.5 s of latency in a turn of kStraight_rad per fix.
  static constexpr float kOffTrack = 0.577F;
  /// Largest change of the heading between two fixes whose displacement is compared with the
  /// heading, rad.
  static constexpr float kStraight_rad = 0.1F;
  /// For this time, s, after a change of the commanded direction, a motion against the command
  /// counts as braking and not as a fault. It must not be faster than at the change by more than
  /// kFaster_mps, m/s.
  static constexpr float kBraking_s = 10.0F;
  static constexpr float kFaster_mps = 0.5F;
};

}  // namespace awmr
