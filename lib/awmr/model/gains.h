/// Controller gains and their time constants. Freestanding C++14.
#pragma once

namespace awmr {

/// Heading, S = e_dot + lambda e in rad/s.                                        [paper (82), (89)]
template <class T>
struct HeadingGains {
  T lambda;   ///< 1/s, > 0: slope of the sliding surface
  T mu;       ///< rad/s^2, > 0: corrective yaw acceleration, has to dominate |disturbance|/I'z
  T epsilon;  ///< rad/s, > 0: half width of the boundary layer, |S| <= epsilon

  /// T1 = 1/lambda, s: decay of the error on the surface.                               [paper (91)]
  T sliding_time_constant_s() const { return T(1.0) / lambda; }
  /// T2 = epsilon/(2 mu), s: decay of V = S^2/2 in the layer. S itself decays with 2 T2. [paper (95)]
  T reaching_time_constant_s() const { return epsilon / (T(2.0) * mu); }
};

/// Surge, on the error u_d - u.                                                        [paper (102)]
template <class T>
struct SpeedGains {
  T mu;       ///< m/s^2, > 0
  T epsilon;  ///< m/s, > 0
};

template <class T>
struct Gains {
  HeadingGains<T> heading;
  SpeedGains<T> speed;
};

}  // namespace awmr
