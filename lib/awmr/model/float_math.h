/// sin, cos, atan, atan2 and the wrap of an angle for float. Freestanding C++14.
///
/// Made of operations that IEEE 754 rounds exactly (add, subtract, multiply, divide) and of
/// comparisons, so that the ATmega2560 and a host compiled with -ffp-contract=off give the same
/// bits; the C libraries' own differ in the last one. Polynomials are minimax by the Remez exchange
/// on the reduced interval, in z = x^2. The worst errors are those of tests/model/float_math_test,
/// over every float of the range when run with AWMR_EXHAUSTIVE=1.
///
/// Angles are taken up to kAngleMax either side; beyond it, and for infinities and NaN, the result
/// is NaN, which a caller can see.
#pragma once

#include <math.h>

namespace awmr {
namespace float_math {

constexpr float kAngleMax = 8192.0F;

constexpr float kPi = 3.14159265F;
constexpr float kPiBy2 = 1.57079633F;
constexpr float kPiBy2Low = -4.37113883e-8F;  // pi/2 less its float
constexpr float kPiBy4 = 0.785398163F;
constexpr float kPiBy4Low = -2.18556941e-8F;

inline float not_a_number() { return __builtin_nanf(""); }

/// The whole number nearest to x, halves away from 0. |x| < 32767, so that AVR's int holds it.
inline int nearest(float x) { return static_cast<int>(x < 0.0F ? x - 0.5F : x + 0.5F); }

namespace detail {

/// x - k pi/2 by Cody and Waite: the first two parts have 11 bits, so that k times either is exact.
inline float reduced(float x, int k) {
  const float turns = static_cast<float>(k);
  return ((x - turns * 1.5703125F) - turns * 4.837512969970703125e-4F) - turns * 7.54978995e-8F;
}

/// sin x = x + x^3 P(z), |x| <= pi/4: approximation error below 3.8e-9 of the value.
inline float sin_poly(float x) {
  const float z = x * x;
  return x + x * z * (-0.166666546F + z * (8.33216017e-3F + z * -1.95152010e-4F));
}

/// cos x = 1 - z/2 + z^2 P(z), |x| <= pi/4: approximation error below 1e-10.
inline float cos_poly(float x) {
  const float z = x * x;
  return 1.0F - (0.5F * z - z * z * (0.0416666469F + z * (-1.38873667e-3F + z * 2.44383600e-5F)));
}

/// atan t = t + t^3 P(z): below 2.4e-9 of the value for |t| <= 0.2, 2.1e-8 for |t| <= tan(pi/8).
inline float atan_poly(float t) {
  const float z = t * t;
  if (z <= 0.04F) {
    return t + t * z * (-0.333332113F + z * (0.199813447F + z * -0.134689404F));
  }
  return t + t * z * (-0.333329491F + z * (0.199777094F + z * (-0.138776729F + z * 0.0805370467F)));
}

constexpr float kTanPiBy8 = 0.414213562F;

/// atan(small/large), 0 <= small <= large, large > 0: one division.
inline float atan_of_ratio(float small, float large) {
  if (small > kTanPiBy8 * large) {
    // atan t = pi/4 + atan((t - 1)/(t + 1))
    return kPiBy4 + (atan_poly((small - large) / (small + large)) + kPiBy4Low);
  }
  return atan_poly(small / large);
}

/// sin(x + quarter pi/2).
inline float sin_from(float x, int quarter) {
  if (!(::fabsf(x) <= kAngleMax)) return not_a_number();
  const int k = nearest(x * 0.636619772F);
  const float rest = reduced(x, k);
  const int quadrant = (k + quarter) & 3;
  const float value = (quadrant & 1) != 0 ? cos_poly(rest) : sin_poly(rest);
  return (quadrant & 2) != 0 ? -value : value;
}

}  // namespace detail

/// Worst error 7.9e-8.
inline float sin(float x) { return detail::sin_from(x, 0); }

/// Worst error 7.9e-8.
inline float cos(float x) { return detail::sin_from(x, 1); }

/// Worst error 2.4 units in the last place.
inline float atan(float x) {
  const float size = ::fabsf(x);
  if (size <= detail::kTanPiBy8) return detail::atan_poly(x);
  if (!(size <= 3.4e38F)) {
    if (!(size > 3.4e38F)) return not_a_number();
    return x < 0.0F ? -kPiBy2 : kPiBy2;
  }
  const float angle = size > 1.0F ? kPiBy2 - (detail::atan_of_ratio(1.0F, size) - kPiBy2Low)
                                  : detail::atan_of_ratio(size, 1.0F);
  return x < 0.0F ? -angle : angle;
}

/// The angle of (x, y) in (-pi, pi], 0 at the origin; a zero has no sign here. Both finite and
/// below 1.7e38. Worst error 3e-7, near pi.
inline float atan2(float y, float x) {
  const float side = ::fabsf(x);
  const float height = ::fabsf(y);
  if (!(side > 0.0F) && !(height > 0.0F) && side <= 0.0F && height <= 0.0F) return 0.0F;
  float angle = height > side ? kPiBy2 - (detail::atan_of_ratio(side, height) - kPiBy2Low)
                              : detail::atan_of_ratio(height, side);
  if (x < 0.0F) angle = kPi - (angle - 2.0F * kPiBy2Low);
  return y < 0.0F ? -angle : angle;
}

/// The angle's equal in (-pi, pi]: unchanged where it is there already.
inline float wrapped(float x) {
  if (x <= kPi && x > -kPi) return x;
  if (!(::fabsf(x) <= kAngleMax)) return not_a_number();
  const float turns = static_cast<float>(nearest(x * 0.159154943F));
  // 2 pi in three parts, as in detail::reduced.
  float rest = ((x - turns * 6.28125F) - turns * 1.93500518798828125e-3F) - turns * 3.01991598e-7F;
  if (rest > kPi) rest -= 2.0F * kPi;
  if (!(rest > -kPi)) rest += 2.0F * kPi;
  return rest;
}

}  // namespace float_math
}  // namespace awmr
