/// Stanley, a guidance law that follows a line.
///
/// The approach angle grows with the ratio of the distance from the line to the speed. So the
/// distance decreases with nearly the same time constant at every speed well above `softening_mps`.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of Stanley.
template <class T>
struct Stanley {
  /// k, 1/s, > 0: gain. Near the line, the distance decreases with the time t as exp(-k t u/(k_s +
  /// u)) at the speed u. With a larger k, the line is reached sooner and the vehicle turns more
  /// abruptly.
  T gain_per_s;
  /// k_s, m/s, > 0: speed that is added to u. With a larger k_s, the vehicle turns less abruptly at
  /// low speed.
  T softening_mps;
  bool sideslip_compensation;

  static constexpr bool kUsesCorner = true;
  static const char* name() { return "stanley"; }
  template <class Law, class Field>
  static void parameters(Law& law, Field field) {
    field("gain_per_s", law.gain_per_s, LawParameter{0.0, 100.0, true, 1.0});
    field("softening_mps", law.softening_mps, LawParameter{0.0, 1e3, true, 1.0});
  }
};

/// Returns the approach angle atan(k e/(k_s + u)), rad, which guide() in line.h subtracts from the
/// direction psi_AB of the line:
///   psi_d = psi_AB - beta - atan(k e/(k_s + u))
/// e: distance of the centre of gravity from the line, m, left positive; u: speed, where a vehicle
/// that rolls backward counts as at rest; beta: sideslip angle. (Hoffmann, Tomlin, Montemerlo,
/// Thrun, Autonomous automobile trajectory tracking for off-road driving, 2007. They use the
/// distance of the front axle and command the steering angle; here the heading psi_d is commanded.)
template <class T>
T approach_rad(const Stanley<T>& law, const AlongSegment<T>& s, const LineMotion<T>& motion,
               T& /*memory*/) {
  using math::atan;
  const T forward_mps = math::larger(motion.u_mps, T(0.0));
  return atan(T(law.gain_per_s * s.cross_track_m / (law.softening_mps + forward_mps)));
}

}  // namespace awmr
