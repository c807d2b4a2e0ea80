/// Integral line of sight (ILOS), a guidance law that follows a line.
///
/// With plain line of sight, a side slope, an unmeasured sideslip or a steady heading error keeps
/// the vehicle at a constant distance from the line, parallel to it. ILOS integrates this distance
/// and aims at a point beyond the line, until the vehicle is on the line.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of integral line-of-sight guidance.
template <class T>
struct IntegralLos {
  /// Lookahead distance Delta, m, > 0: distance along the line to the point at which the vehicle
  /// aims. With a larger distance, the motion is smoother, and the line is reached later.
  T lookahead_m;
  /// Integral gain sigma, m/s, > 0. The literature requires a value below the vehicle's speed. With
  /// a larger gain, disturbances are compensated sooner, and the vehicle overshoots the line more.
  T integral_gain_mps;
  bool sideslip_compensation;

  static constexpr bool kUsesCorner = true;
  static const char* name() { return "ilos"; }
  template <class Law, class Field>
  static void parameters(Law& law, Field field) {
    field("lookahead_m", law.lookahead_m, lookahead_range());
    field("integral_gain_mps", law.integral_gain_mps, LawParameter{0.0, 1e3, true, 1.0});
  }
};

/// Returns the approach angle atan(q), rad, which guide() in line.h subtracts from the direction
/// psi_AB of the line:
///   psi_d     = psi_AB - beta - atan(q),   q = (e + sigma y_int)/Delta
///   y_int_dot = Delta e/((e + sigma y_int)^2 + Delta^2) = e/(Delta (1 + q^2))
/// e: distance from the line, m, left positive; y_int: its integral, s; beta: sideslip angle.
/// (Borhaug, Pavlov, Pettersen, Integral LOS control for path following of underactuated marine
/// surface vessels in the presence of constant ocean currents, 2008, (7); Lekkas, Fossen, Integral
/// LOS path following for curved paths based on a monotone cubic Hermite spline, 2014.)
///
/// Far from the line, y_int hardly grows, so it does not wind up. On each segment, y_int restarts
/// at 0, because the disturbance has another direction relative to the new segment.
template <class T>
T approach_rad(const IntegralLos<T>& law, const AlongSegment<T>& s, const LineMotion<T>& motion,
               T& integral_s) {
  using math::atan;
  const T q = (s.cross_track_m + law.integral_gain_mps * integral_s) / law.lookahead_m;
  integral_s += motion.sample_time_s * (s.cross_track_m / (law.lookahead_m * (T(1.0) + q * q)));
  return atan(q);
}

}  // namespace awmr
