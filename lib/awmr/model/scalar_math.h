/// Elementary functions for any scalar. Freestanding C++14.
///
/// Templates call `using math::sin; sin(x)`. For float and double, this finds the functions below.
/// For ceres::Jet and other scalars, it finds the functions in the scalar's own namespace
/// (argument-dependent lookup). float uses sin, cos, atan and atan2 of float_math.h, with the same
/// bits on every machine.
#pragma once

#include <math.h>

#include "awmr/model/float_bearing.h"
#include "awmr/model/float_math.h"

/// Attribute of a helper that is always inlined on the chip (AVR microcontroller).
#ifdef __AVR__
#define AWMR_NO_CALL inline __attribute__((always_inline))
#else
#define AWMR_NO_CALL inline
#endif

/// Attribute of a function template that is rarely called: it is not inlined into its callers.
#define AWMR_COLD __attribute__((noinline, cold))

namespace awmr {

/// Result type of a comparison of two T: bool. A batch of vehicles, whose lanes can differ, has its
/// own mask type with any(), all(), select() and the operators !, && and ||
/// (simulate/simd/lanes.h).
///
/// A branch that can differ between lanes is written as
///   if (any(m)) { if (MaskOf<T>::kOneLane || all(m)) return a;  x = select(m, a, x); }
/// For bool this is an ordinary branch. The compiler knows the constant kOneLane before it decides
/// on inlining, which affects the flash size on the chip.
template <class T>
struct MaskOf {
  using Type = bool;
  static constexpr bool kOneLane = true;
};
template <class T>
using Mask = typename MaskOf<T>::Type;

namespace math {

AWMR_NO_CALL bool any(bool mask) { return mask; }
AWMR_NO_CALL bool all(bool mask) { return mask; }
/// `chosen` if the mask is true, else `other`.
template <class T>
AWMR_NO_CALL T select(bool mask, const T& chosen, const T& other) {
  return mask ? chosen : other;
}

inline float abs(float x) { return ::fabsf(x); }
inline double abs(double x) { return ::fabs(x); }
inline float sqrt(float x) { return ::sqrtf(x); }
inline double sqrt(double x) { return ::sqrt(x); }
inline float sin(float x) { return float_math::sin(x); }
inline double sin(double x) { return ::sin(x); }
inline float cos(float x) { return float_math::cos(x); }
inline double cos(double x) { return ::cos(x); }
inline float atan(float x) { return float_math::atan(x); }
inline double atan(double x) { return ::atan(x); }
inline float atan2(float y, float x) { return float_math::called_atan2(y, x); }
inline double atan2(double y, double x) { return ::atan2(y, x); }
inline double hypot(double x, double y) { return ::hypot(x, y); }
/// 2 atan x.
template <class T>
T twice_atan(const T& x) {
  return T(2.0) * atan(x);
}
inline float twice_atan(float x) { return float_math::twice_atan(x); }
inline float pow(float x, float y) { return ::powf(x, y); }
inline double pow(double x, double y) { return ::pow(x, y); }

/// sat(x, limit): x clamped to [-limit, limit].
template <class T>
T saturate(const T& x, const T& limit) {
  using math::select;
  return select(x > limit, limit, select(x < -limit, T(-limit), x));
}

/// saturate() for float, limit >= 0, by comparing bits, which is faster on the chip. NaN stays NaN.
inline float saturate(float x, float limit) {
  const uint32_t magnitude = float_math::magnitude_bits(x);
  if (magnitude <= float_math::magnitude_bits(limit) || float_math::is_nan(x)) return x;
  return bits_of(x) >> 31U != 0 ? -limit : limit;
}

/// The larger value; x if they are equal or one is NaN.
template <class T>
T larger(const T& x, const T& y) {
  using math::select;
  return select(x < y, y, x);
}

/// Returns x; for float, 0 if |x| < 2^-90. Use it for a number that is divided by a force later:
/// the quotient of a tinier number could be subnormal, and an AVR rounds subnormal numbers
/// differently from a host.
template <class T>
T flushed(const T& x) {
  return x;
}
inline float flushed(float x) { return float_math::leading_bits(x) < 0x1280U ? 0.0F : x; }

/// a - b. If a is 0, the float version returns -b, which is faster on the chip. This case is
/// common: the rate of a constant reference is 0.
template <class T>
T difference(const T& a, const T& b) {
  return a - b;
}
inline float difference(float a, float b) {
  return float_math::magnitude_bits(a) == 0 ? -b : a - b;
}

/// a + b c. For float, returns a without arithmetic if c is 0, which is faster on the chip.
template <class T>
T plus_product(const T& a, const T& b, const T& c) {
  return a + b * c;
}
inline float plus_product(float a, float b, float c) {
  return float_math::magnitude_bits(c) == 0 ? a : a + b * c;
}

/// x > y; false for NaN. For float, bits are compared as integers, in a third of the cycles of a
/// float comparison on the chip.
template <class T>
Mask<T> is_above(const T& x, const T& y) {
  return x > y;
}
AWMR_CALLED inline bool is_above(float x, float y) {
  if (float_math::leading_order_of(x) < float_math::leading_order_of(y)) return false;
  return float_math::order_of(x) > float_math::order_of(y) && !float_math::is_nan(x) &&
         !float_math::is_nan(y);
}

/// True if x and y differ; false for NaN. The float version compares only the bits, so -0 and 0
/// differ. Use it only if x is a copy of y, or the limit to which y was clamped.
template <class T>
Mask<T> is_different(const T& x, const T& y) {
  return x < y || x > y;
}
inline bool is_different(float x, float y) { return bits_of(x) != bits_of(y); }

/// |x| > limit, limit >= 0. The float version compares the bits; for it, NaN is beyond every limit.
template <class T>
Mask<T> is_beyond(const T& x, const T& limit) {
  return x > limit || -x > limit;
}
inline bool is_beyond(float x, float limit) {
  return float_math::magnitude_bits(x) > bits_of(limit);
}

/// `size` with the sign of `of`; `size` itself if `of` is 0. For float, by the bits of `of`.
template <class T>
T with_sign(const T& size, const T& of) {
  using math::select;
  return select(of < T(0.0), T(-size), size);
}
inline float with_sign(float size, float of) { return bits_of(of) > 0x80000000UL ? -size : size; }

/// True if x is 0 or -0; x must not be NaN.
template <class T>
Mask<T> is_zero(const T& x) {
  return !(x > T(0.0)) && !(x < T(0.0));
}
inline bool is_zero(float x) { return float_math::magnitude_bits(x) == 0; }

/// True if one number is positive and the other negative. For float, without a multiplication.
template <class T>
Mask<T> is_opposite(const T& x, const T& y) {
  return x * y < T(0.0);
}
inline bool is_opposite(float x, float y) {
  return ((bits_of(x) ^ bits_of(y)) >> 31U) != 0 && float_math::magnitude_bits(x) != 0 &&
         float_math::magnitude_bits(y) != 0;
}

/// The angle of (x, y) in (-pi, pi], for directions to steer by: atan2. For float, an approximation
/// with an error below 4.1e-5 rad, which takes a third of the cycles on the chip.
template <class T>
T bearing(const T& y, const T& x) {
  return atan2(y, x);
}
inline float bearing(float y, float x) { return float_math::bearing(y, x); }

/// x clamped to [lo, hi]; lo <= hi.
template <class T>
T clamp(const T& x, const T& lo, const T& hi) {
  using math::select;
  return select(x > hi, hi, select(x < lo, lo, x));
}
/// clamp() for float; usually the leading 16 bits decide, which is faster on the chip. NaN stays
/// NaN.
AWMR_CALLED inline float clamp(float x, float lo, float hi) {
  if (float_math::is_inside(x, lo, hi)) return x;
  if (is_above(x, hi)) return hi;
  return is_above(lo, x) ? lo : x;
}

}  // namespace math
}  // namespace awmr
