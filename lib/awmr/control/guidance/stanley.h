/// Stanley, a guidance law that follows a line. Freestanding C++14.
///
/// The approach angle depends on the ratio of the distance from the line to the speed. So the
/// distance falls with nearly the same time constant at every speed well above `softening_mps`.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of Stanley.
template <class T>
struct Stanley {
  /// k, 1/s, > 0: near the line, the distance falls as exp(-k t u/(k_s + u)). Larger: the line is
  /// reached sooner and more abruptly.
  T gain_per_s;
  /// k_s, m/s, > 0: added to the speed. Larger: smoother at low speed.
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

/// The approach angle atan(k e/(k_s + u)), rad, which guide() in line.h subtracts:
///   psi_d = psi_AB - beta - atan(k e/(k_s + u))
/// (Hoffmann, Tomlin, Montemerlo, Thrun, Autonomous automobile trajectory tracking for off-road
/// driving, 2007. They use the distance of the front axle from the line and command the steering
/// angle; here e is the distance of the centre of gravity, m, left positive, and psi_d is
/// commanded.) A vehicle that rolls backward counts as at rest.
template <class T>
T approach_rad(const Stanley<T>& law, const AlongSegment<T>& s, const LineMotion<T>& motion,
               T& /*memory*/) {
  using math::atan;
  const T forward_mps = math::larger(motion.u_mps, T(0.0));
  return atan(T(law.gain_per_s * s.cross_track_m / (law.softening_mps + forward_mps)));
}

}  // namespace awmr
