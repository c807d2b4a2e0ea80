/// Line of sight, the paper's guidance law that follows a line.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of the line-of-sight law.
template <class T>
struct LineOfSight {
  /// Delta, rad, in (0, pi/2]: approach angle of a vehicle that is farther than R from the line.
  /// With a larger angle, the vehicle takes a shorter way to the line and turns more abruptly.
  T delta_rad;
  /// R, m, > 0: within this distance of the line, the approach angle is proportional to the
  /// distance. With a larger R, the motion is smoother, and the line is reached later.
  T width_m;
  bool sideslip_compensation;

  static constexpr bool kUsesCorner = true;
  static const char* name() { return "los"; }
  template <class Law, class Field>
  static void parameters(Law& law, Field field) {
    field("delta_deg", law.delta_rad,
          LawParameter{0.0, 90.0, true, 3.14159265358979323846 / 180.0});
    field("width_m", law.width_m, LawParameter{0.0, 1e6, true, 1.0});
  }
};

/// Returns the approach angle Delta sat(e/R), rad, which guide() in line.h subtracts from the
/// direction psi_AB of the line:
///   psi_d = psi_AB - beta - Delta sat(e/R)                                           [paper (107)]
/// e: distance from the line, m, left positive; beta: sideslip angle.
template <class T>
AWMR_INLINE T approach_rad(const LineOfSight<T>& law, const AlongSegment<T>& s,
                           const LineMotion<T>&, T& /*memory*/) {
  return law.delta_rad * math::saturate(s.cross_track_m / law.width_m, T(1.0));
}

}  // namespace awmr
