/// Integral line of sight (ILOS), a guidance law that follows a line. Freestanding C++14.
///
/// A vehicle that aims at a point of the line is driven off the line by a side slope, an unmeasured
/// sideslip or a steady heading error. It then drives parallel to the line at a constant offset.
/// ILOS integrates the offset and shifts the aim to the other side of the line until the vehicle is
/// on the line.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of integral line-of-sight guidance.
template <class T>
struct IntegralLos {
  /// Delta, m, > 0: distance along the line from the vehicle to the point at which it aims. Larger:
  /// smoother, and slower to reach the line.
  T lookahead_m;
  /// sigma, m/s, > 0: gain of the integral. The literature requires less than the vehicle's speed.
  /// Larger: disturbances are compensated sooner, and the line is overshot more.
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

/// The approach angle atan(q), rad, which guide() in line.h subtracts. With the distance e from the
/// line, m, left positive, and its integral y_int, s:
///   psi_d     = psi_AB - beta - atan(q),   q = (e + sigma y_int)/Delta
///   y_int_dot = Delta e/((e + sigma y_int)^2 + Delta^2) = e/(Delta (1 + q^2))
/// (Borhaug, Pavlov, Pettersen, Integral LOS control for path following of underactuated marine
/// surface vessels in the presence of constant ocean currents, 2008, (7); Lekkas, Fossen, Integral
/// LOS path following for curved paths based on a monotone cubic Hermite spline, 2014). Far from
/// the line, y_int hardly grows, so it does not wind up. y_int restarts at 0 on each segment,
/// because the disturbance has another direction relative to the new segment.
template <class T>
T approach_rad(const IntegralLos<T>& law, const AlongSegment<T>& s, const LineMotion<T>& motion,
               T& integral_s) {
  using math::atan;
  const T q = (s.cross_track_m + law.integral_gain_mps * integral_s) / law.lookahead_m;
  integral_s += motion.sample_time_s * (s.cross_track_m / (law.lookahead_m * (T(1.0) + q * q)));
  return atan(q);
}

}  // namespace awmr
