/// Following a line or a polyline by integral line of sight (ILOS), a baseline beside the law of
/// guidance_line.h. Freestanding C++14.
///
/// A side slope, a sideslip that no sensor shows or a heading that is held with an error leave a
/// vehicle that aims at the line beside it. ILOS aims so far to the other side that it comes to lie
/// on it.
#pragma once

#include "awmr/control/guidance_line.h"

namespace awmr {

/// How a line is approached by integral line of sight.
template <class T>
struct IntegralLos {
  /// Delta, m, > 0: how far ahead on the line the vehicle aims. Larger: smoother, and later on the
  /// line.
  T lookahead_m;
  /// sigma, m/s, > 0: how fast the aim is moved aside. The literature asks for less than the speed;
  /// larger: what pushes the vehicle off the line is made up for sooner, and the line overshot more.
  T integral_gain_mps;
  bool sideslip_compensation;  ///< as in LineLaw
};

/// What integral line of sight remembers from step to step.
template <class T>
struct CrossTrackIntegral {
  T integral_s;  ///< y_int, s
  int segment;   ///< the segment that it belongs to
};

/// The integral before the first step.
template <class T>
CrossTrackIntegral<T> start_integral() {
  return {T(0.0), 0};
}

/// The heading that leads to a line of direction psi_AB and then along it, rad, in (-pi, pi]:
///   psi_d     = psi_AB - beta - atan(q),   q = (e + sigma y_int)/Delta
///   y_int_dot = Delta e/((e + sigma y_int)^2 + Delta^2) = e/(Delta (1 + q^2))
/// (Borhaug, Pavlov, Pettersen, Integral LOS control for path following of underactuated marine
/// surface vessels in the presence of constant ocean currents, 2008, (7); Lekkas, Fossen, Integral
/// LOS path following for curved paths based on a monotone cubic Hermite spline, 2014). beta as in
/// line_heading_rad(). Far from the line y_int hardly grows: the law does not wind up.
template <class T>
T line_heading_rad(const IntegralLos<T>& law, const T& psi_line_rad, const T& cross_track_m,
                   const T& sideslip, const T& sample_time_s, T& integral_s) {
  using math::atan;
  const T q = (cross_track_m + law.integral_gain_mps * integral_s) / law.lookahead_m;
  integral_s += sample_time_s * (cross_track_m / (law.lookahead_m * (T(1.0) + q * q)));
  const T beta = law.sideslip_compensation ? sideslip : T(0.0);
  return called_wrap_angle(T(psi_line_rad - beta - atan(q)));
}

/// guide() of guidance_line.h by this law. On each new segment y_int begins at 0: what pushes the
/// vehicle aside comes from another side there.
template <class T>
PolylineGuidance<T> guide(const Polyline<T, IntegralLos<T>>& line, const Position<T>& position_m,
                          const T& sideslip, const T& sample_time_s, PolylineProgress<T>& progress,
                          CrossTrackIntegral<T>& integral) {
  const auto heading_rad = [&](const T& psi_line_rad, const T& cross_track_m) {
    if (integral.segment != progress.segment) integral = {T(0.0), progress.segment};
    return line_heading_rad(line.law, psi_line_rad, cross_track_m, sideslip, sample_time_s,
                            integral.integral_s);
  };
  return guide_by(line, position_m, heading_rad, progress);
}

}  // namespace awmr
