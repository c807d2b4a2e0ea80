/// The angle of a plane vector (atan2) for float, computed with 16-bit integers. Freestanding
/// C++14.
///
/// Guidance steers along this angle, so its error (below 4.1e-5 rad) need only be small compared
/// with that of a heading sensor. An 8-bit processor divides 16-bit integers in half the time of
/// floats, and integer results are the same on every machine.
#pragma once

#include <stdint.h>

#include "awmr/model/float_math.h"

namespace awmr {
namespace float_math {
namespace detail {

/// Leading 16 bits of the mantissa of a normal float, including the hidden bit. `bits`: the bits of
/// the float.
inline uint16_t mantissa16(uint32_t bits) {
  return static_cast<uint16_t>(bits >> 8U) | static_cast<uint16_t>(0x8000U);
}

/// Returns 2^16 small/large, rounded to nearest and at most 2^16 - 1. The arguments are the bits of
/// two magnitudes, small <= large. Divides the mantissas by long division. If the exponents differ
/// by n, the quotient has 16 - n bits; for n > 16, it is 0.
inline uint16_t ratio16(uint32_t small, uint32_t large) {
  const uint16_t divisor = mantissa16(large);
  uint16_t rest = mantissa16(small);
  const uint8_t apart = static_cast<uint8_t>((large >> 23U) - (small >> 23U));
  if (apart > 16) return 0;
  uint16_t ratio = 0;
  if (rest >= divisor) {
    if (apart == 0) return 0xFFFFU;  // 1: limited to the largest value that fits
    rest = static_cast<uint16_t>(rest - divisor);
    ratio = 1;
  }
  for (uint8_t bit = apart; bit < 16; ++bit) {
    const bool carry = (rest & 0x8000U) != 0;
    rest = static_cast<uint16_t>(rest << 1U);
    ratio = static_cast<uint16_t>(ratio << 1U);
    if (carry || rest >= divisor) {
      rest = static_cast<uint16_t>(rest - divisor);
      ratio = static_cast<uint16_t>(ratio | 1U);
    }
  }
  // Rounds up if the remainder is at least half of the divisor, but never up to a ratio of 1.
  const bool up = rest >= divisor - rest && ratio != 0xFFFFU;
  return static_cast<uint16_t>(up ? ratio + 1U : ratio);
}

/// a b / 2^16, rounded down.
inline uint16_t product16(uint16_t a, uint16_t b) {
  return static_cast<uint16_t>((static_cast<uint32_t>(a) * b) >> 16U);
}

/// Arc tangent with fixed-point numbers: `t` is 2^16 times a number in [0, 1), the result 2^17
/// times its arc tangent in rad. The minimax polynomial
///   t - t (c0 + z (c1 - z (c2 - z (c3 - z c4)))),   z = t^2
/// is within 1.2e-5 rad of atan t. The constants in the code are its coefficients times 2^17.
inline uint32_t atan17(uint16_t t) {
  const uint16_t z = product16(t, t);
  uint16_t p = static_cast<uint16_t>(11162U - product16(z, 2732U));
  p = static_cast<uint16_t>(23614U - product16(z, p));
  p = static_cast<uint16_t>(43294U - product16(z, p));
  p = static_cast<uint16_t>(18U + product16(z, p));
  return (static_cast<uint32_t>(t) << 1U) - product16(t, p);
}

constexpr int32_t kQuarterTurn17 = 205887;  ///< pi/2 times 2^17
constexpr int32_t kHalfTurn17 = 411774;     ///< pi times 2^17, rounded down: no angle is above pi

constexpr uint32_t kExponent17 = static_cast<uint32_t>(17) << 23U;  ///< 17 in a float's exponent

/// whole / 2^17, exact for |whole| < 2^24.
inline float by_two_to_17(int32_t whole) {
  if (whole == 0) return 0.0F;
  return float_of(bits_of(static_cast<float>(whole)) - kExponent17);
}

}  // namespace detail

/// The angle of (x, y) in (-pi, pi], like atan2 of this namespace, but with an error of up to
/// 4.1e-5 rad. Precondition: |x| or |y| is at least 1e-30. NaN for non-finite input.
inline float bearing(float y, float x) {
  uint32_t small = magnitude_bits(y);
  uint32_t large = magnitude_bits(x);
  const bool steep = small > large;
  if (steep) {
    const uint32_t height = small;
    small = large;
    large = height;
  }
  if (large >= kInfinityBits) return not_a_number();
  // Round the mantissas to 16 bits: add half of the last place that is kept, before the rest is cut
  // off.
  int32_t angle =
      static_cast<int32_t>(detail::atan17(detail::ratio16(small + 0x80U, large + 0x80U)));
  if (steep) angle = detail::kQuarterTurn17 - angle;
  if (bits_of(x) >> 31U != 0) angle = detail::kHalfTurn17 - angle;
  return detail::by_two_to_17(bits_of(y) >> 31U != 0 ? -angle : angle);
}

}  // namespace float_math
}  // namespace awmr
