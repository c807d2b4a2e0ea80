/// Input and constants of the position estimate (position_estimate.h).
#pragma once

#include <stdint.h>

#include "awmr/control/guidance/position.h"

namespace awmr {

/// A fix: a position that a GPS receiver has measured.
template <class T>
struct PositionFix {
  Position<T> position_m;
  T age_s;      ///< time since the fix was taken, s, >= 0
  bool is_new;  ///< true: this fix has not been processed by a step yet
};

/// q, m^2/s: growth of the variance of the dead-reckoned position per second, caused by errors of
/// heading and speed.
constexpr double kDrift_m2ps = 0.05;
/// Time over which the correction by a fix is spread, s, so that the estimate does not jump.
constexpr double kSpread_s = 0.08;
/// Smallest standard deviation of a fix, m. It is used for a receiver without noise.
constexpr double kFixNoiseMin_m = 0.01;
/// Largest permitted innovation |nu| divided by its standard deviation sqrt(P + R). A larger value
/// rejects fewer good fixes and accepts more wrong ones. With normally distributed errors, one of
/// 300,000 good fixes is rejected.
constexpr double kInnovationMax = 5.0;
/// Number of consecutive rejected fixes after which the estimate is reset to the last fix.
constexpr uint8_t kRejections = 5;
/// Number of past dead-reckoned positions that the ring buffer stores, a power of two.
constexpr uint8_t kTravelled = 8;

/// Constants of the position estimate. position_filter() computes them once.
template <class T>
struct PositionFilter {
  T sample_time_s;       ///< T_s, s
  T sample_rate_hz;      ///< 1/T_s
  T fix_variance_m2;     ///< R, variance of a fix per axis
  T drift_m2;            ///< q T_s, growth of P in a step
  T stride_inverse;      ///< 1/stride
  T spread_inverse;      ///< 1/spread_steps
  uint8_t stride;        ///< steps between two positions stored in the ring buffer
  uint8_t spread_steps;  ///< steps over which the correction by a fix is spread
  bool spreads_work;     ///< the work on a fix is spread over several steps, see GpsLimits
};

namespace detail {

template <class T>
constexpr PositionFilter<T> position_filter(double sample_time_s, double variance_m2,
                                            uint8_t stride, uint8_t spread_steps) {
  return {
      T(sample_time_s),      T(1.0 / sample_time_s), T(variance_m2), T(kDrift_m2ps * sample_time_s),
      T(1.0 / stride),       T(1.0 / spread_steps),  stride,         spread_steps,
      sample_time_s < 0.0151};
}
constexpr double squared(double x) { return x * x; }
/// x clamped to [1, 255], rounded down.
constexpr uint8_t to_count(double x) {
  return static_cast<uint8_t>(x > 255.0 ? 255.0 : x < 1.0 ? 1.0 : x);
}

}  // namespace detail

/// Computes the constants for fixes with the standard deviation `noise_m` on each axis and the
/// latency `latency_s`. The ring buffer covers this latency plus 0.1 s, the time in which a fix is
/// processed.
template <class T>
constexpr PositionFilter<T> position_filter(double noise_m, double latency_s,
                                            double sample_time_s) {
  return detail::position_filter<T>(
      sample_time_s, detail::squared(noise_m > kFixNoiseMin_m ? noise_m : kFixNoiseMin_m),
      detail::to_count(1.0 + (latency_s + 0.1) / ((kTravelled - 2) * sample_time_s)),
      detail::to_count(kSpread_s / sample_time_s + 0.5));
}

}  // namespace awmr
