/// sin, cos, atan, atan2 and the wrap of an angle for float. Freestanding C++14.
///
/// Uses only comparisons and operations that IEEE 754 rounds correctly (add, subtract, multiply,
/// divide). So the ATmega2560 and a host compiled with -ffp-contract=off give the same bits, unlike
/// the functions of their C libraries, which differ in the last bit. The polynomials in z = x^2 are
/// minimax approximations, found by the Remez exchange. tests/model/float_math_test checks the
/// worst errors given below; with AWMR_EXHAUSTIVE=1 it checks every float of the range.
///
/// Angles are valid up to +-kAngleMax. For larger angles, infinities and NaN, the result is NaN,
/// which a caller can detect.
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(__GNUC__) && __GNUC__ == 7
// GCC 7, used by the Arduino IDE, gives a false warning about overloads of which only one has an
// attribute.
#pragma GCC diagnostic ignored "-Wattributes"
#endif

/// Attribute of a function without tight time limits: an AVR compiler must not inline it, and must
/// optimise it for size.
#ifdef __AVR__
#define AWMR_CALLED __attribute__((noinline, optimize("Os")))
/// As AWMR_CALLED, for member functions. The compiler must also not make a copy (clone) of the
/// function for a single object: its absolute addresses make the code twice as long as addresses
/// relative to the object.
#define AWMR_CALLED_MEMBER __attribute__((noinline, noclone, optimize("Os")))
#else
#define AWMR_CALLED
#define AWMR_CALLED_MEMBER
#endif

namespace awmr {

/// The 32 bits of a float, and back.
inline uint32_t bits_of(float value) {
  uint32_t bits = 0;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline float float_of(uint32_t bits) {
  float value = 0.0F;
  memcpy(&value, &bits, sizeof value);
  return value;
}

namespace float_math {

/// The bits of |x| as an integer. The integers of two numbers compare like the magnitudes of the
/// numbers. On the chip (ATmega2560), comparing them takes half the cycles of a float comparison. A
/// result above kInfinityBits is a NaN.
inline uint32_t magnitude_bits(float x) { return bits_of(x) & 0x7FFFFFFFUL; }
constexpr uint32_t kInfinityBits = 0x7F800000UL;

/// An integer for comparisons: order_of(x) < order_of(y) if x < y. -0 is equal to 0; a NaN is
/// beyond the infinity of its sign.
inline int32_t order_of(float x) {
  const int32_t magnitude = static_cast<int32_t>(magnitude_bits(x));
  return (bits_of(x) & 0x80000000UL) != 0 ? -magnitude : magnitude;
}
inline bool is_nan(float x) { return magnitude_bits(x) > kInfinityBits; }

/// The leading 16 bits of |x|: exponent and seven bits of mantissa. If the leading bits of two
/// numbers differ, they compare like the magnitudes of the numbers. Comparing them takes half the
/// cycles of comparing magnitude_bits().
inline uint16_t leading_bits(float x) {
  return static_cast<uint16_t>(bits_of(x) >> 16U) & static_cast<uint16_t>(0x7FFFU);
}
/// Leading 16 bits of x as a signed integer. The integers of two numbers compare like the numbers
/// themselves; if the numbers differ only in the lower 16 bits, their integers are equal.
inline int16_t leading_order_of(float x) {
  const int16_t magnitude = static_cast<int16_t>(leading_bits(x));
  return (bits_of(x) & 0x80000000UL) != 0 ? static_cast<int16_t>(-magnitude) : magnitude;
}
/// True if the leading 16 bits alone show that lo < x < hi. False for NaN, and near lo and hi,
/// where the lower 16 bits would decide.
inline bool is_inside(float x, float lo, float hi) {
  const int16_t order = leading_order_of(x);
  return order > leading_order_of(lo) && order < leading_order_of(hi);
}

/// The largest angle, rad, for which sin, cos and wrapped() are valid.
constexpr float kAngleMax = 8192.0F;

constexpr float kPi = 3.14159265F;
constexpr float kPiBy2 = 1.57079633F;
constexpr float kPiBy4 = 0.785398163F;

inline float not_a_number() { return __builtin_nanf(""); }

/// The integer nearest to x, halves away from 0. |x| < 32767, so that AVR's int can hold it.
inline int nearest(float x) { return static_cast<int>(x < 0.0F ? x - 0.5F : x + 0.5F); }

namespace detail {

/// x - k pi/2 by the method of Cody and Waite: pi/2 is a sum of three parts. The first two parts
/// have 11 bits, so that their products with k are exact.
inline float reduced(float x, int k) {
  const float turns = static_cast<float>(k);
  return ((x - turns * 1.5703125F) - turns * 4.837512969970703125e-4F) - turns * 7.54978995e-8F;
}

/// Approximates sin x for |x| <= pi/4 by x + x^3 P(z), with z = x^2 and a polynomial P. The error
/// is below 3.8e-9 of the value.
inline float sin_poly(float x) {
  const float z = x * x;
  return x + x * z * (-0.166666546F + z * (8.33216017e-3F + z * -1.95152010e-4F));
}

/// Approximates cos x for |x| <= pi/4 by 1 - z/2 + z^2 P(z), with z = x^2 and a polynomial P. The
/// error is below 1e-10.
inline float cos_poly(float x) {
  const float z = x * x;
  return 1.0F - (0.5F * z - z * z * (0.0416666469F + z * (-1.38873667e-3F + z * 2.44383600e-5F)));
}

/// Approximates atan t for |t| <= tan(pi/8) by t + t^3 P(z), with z = t^2 and a polynomial P. The
/// error is below 6.6e-7 of the value.
inline float atan_poly(float t) {
  const float z = t * t;
  return t + t * z * (-0.333255076F + z * (0.197141398F + z * -0.112251449F));
}

constexpr float kTanPiBy8 = 0.414213562F;

/// sin(x + k pi/2) of a reduced x.
inline float sin_of_reduced(float x, int k) {
  const float value = (k & 1) != 0 ? cos_poly(x) : sin_poly(x);
  return (k & 2) != 0 ? -value : value;
}

/// sin(x + quarter pi/2), so that quarter 0 is the sine and quarter 1 the cosine.
AWMR_CALLED inline float sin_from(float x, int quarter) {
  if (!(::fabsf(x) <= kAngleMax)) return not_a_number();
  const int k = nearest(x * 0.636619772F);
  return sin_of_reduced(reduced(x, k), k + quarter);
}

}  // namespace detail

/// sin x, |x| <= kAngleMax. Worst absolute error 7.9e-8.
inline float sin(float x) { return detail::sin_from(x, 0); }

/// cos x, |x| <= kAngleMax. Worst absolute error 7.9e-8.
inline float cos(float x) { return detail::sin_from(x, 1); }

namespace detail {

/// `eighths` times pi/4, for 0 to 4.
inline float eighths_of_turn(uint8_t eighths) {
  // No switch, because compilers convert it to a table in RAM.
  if (eighths == 0) return 0.0F;
  if (eighths == 1) return kPiBy4;
  if (eighths == 2) return kPiBy2;
  return eighths == 3 ? 2.35619449F : kPi;
}

}  // namespace detail

/// The angle of (x, y) in (-pi, pi], 0 at the origin; the sign of a zero is ignored. Precondition:
/// |x| and |y| are below 1.7e38. Worst error 5e-7 rad, and 9e-7 relative to the value.
///
/// The angle is computed from the nearest multiple of pi/4: plus or minus the arc tangent of a
/// ratio of at most tan(pi/8).
inline float atan2(float y, float x) {
  float small = ::fabsf(y);
  float large = ::fabsf(x);
  uint8_t eighths = 0;
  bool backwards = false;
  if (magnitude_bits(y) > magnitude_bits(x)) {
    const float height = small;
    small = large;
    large = height;
    eighths = 2;
    backwards = true;
  }
  if (magnitude_bits(large) == 0) return 0.0F;
  float ratio = 0.0F;
  if (small > detail::kTanPiBy8 * large) {
    ratio = (small - large) / (small + large);
    eighths = 1;
  } else {
    ratio = small / large;
  }
  if (bits_of(x) >> 31U != 0 && magnitude_bits(x) != 0) {
    eighths = static_cast<uint8_t>(4U - eighths);
    backwards = !backwards;
  }
  const float part = detail::atan_poly(ratio);
  const float angle = detail::eighths_of_turn(eighths) + (backwards ? -part : part);
  if (bits_of(y) >> 31U == 0 || magnitude_bits(y) == 0) return angle;
  // Slightly below the negative x axis, the angle rounds to half a turn: return +pi, never -pi.
  return eighths == 4 && magnitude_bits(angle) == bits_of(kPi) ? angle : -angle;
}

/// atan2 that is not inlined on the chip, which saves flash; for callers that have time for a call
AWMR_CALLED inline float called_atan2(float y, float x) { return atan2(y, x); }

/// atan x. Worst error 9e-7 relative to the value.
inline float atan(float x) { return atan2(x, 1.0F); }

/// 2 atan x. Worst error relative to the value: 5e-7 for results up to 22.6 deg, 9e-7 beyond.
inline float twice_atan(float x) {
  const float z = x * x;
  // For angles up to 22.6 deg: 2 x + x z P(z), z = x^2, is within 3.4e-7 of the value before
  // rounding.
  if (magnitude_bits(z) <= magnitude_bits(0.04F)) {
    return x * (2.0F + z * (-0.666478631F + z * 0.384626822F));
  }
  const float half = atan(x);
  return half + half;
}

/// The equivalent angle in (-pi, pi]; unchanged if x is in this range. Worst error 5e-7 rad.
inline float wrapped(float x) {
  const uint32_t magnitude = magnitude_bits(x);
  if (magnitude < bits_of(kPi)) return x;
  if (magnitude == bits_of(kPi)) return kPi;
  float rest = x;
  if (magnitude < bits_of(9.42477F)) {
    // Below 3 pi, the common case of a heading that is not wrapped: add or subtract one turn.
    rest = bits_of(x) >> 31U == 0 ? x - 2.0F * kPi : x + 2.0F * kPi;
  } else {
    if (!(magnitude <= bits_of(kAngleMax))) return not_a_number();
    const float turns = static_cast<float>(nearest(x * 0.159154943F));
    // Subtracts multiples of 2 pi in three parts, as detail::reduced() does for pi/2.
    rest = ((x - turns * 6.28125F) - turns * 1.93500518798828125e-3F) - turns * 3.01991598e-7F;
  }
  // Rounding can leave the result slightly outside of (-pi, pi].
  if (magnitude_bits(rest) < bits_of(kPi)) return rest;
  if (bits_of(rest) >> 31U != 0) return rest + 2.0F * kPi;
  return magnitude_bits(rest) == bits_of(kPi) ? rest : rest - 2.0F * kPi;
}

}  // namespace float_math
}  // namespace awmr
