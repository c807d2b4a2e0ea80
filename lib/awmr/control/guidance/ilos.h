/// Integral line-of-sight (ILOS) following of a line or polyline, a baseline for comparison with
/// the law of line.h. Freestanding C++14.
///
/// A side slope, an unmeasured sideslip or a steady heading error leaves a vehicle that aims at the
/// line offset from it. ILOS shifts the aim to the other side until the offset is 0.
#pragma once

#include "awmr/control/guidance/line.h"

namespace awmr {

/// Parameters of integral line-of-sight guidance.
template <class T>
struct IntegralLos {
  /// Delta, m, > 0: lookahead distance along the line. Larger: smoother, and slower to reach the
  /// line.
  T lookahead_m;
  /// sigma, m/s, > 0: speed at which the aim is shifted. The literature requires less than the
  /// vehicle's speed. Larger: disturbances are compensated sooner, and the line is overshot more.
  T integral_gain_mps;
  bool sideslip_compensation;  ///< as in LineLaw
};

/// State of integral line-of-sight guidance between steps.
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

/// The heading that approaches a line of direction psi_AB and then follows it, rad, in (-pi, pi]:
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

/// guide() of line.h with this law. y_int restarts at 0 on each segment, because the
/// disturbance comes from another side there.
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
