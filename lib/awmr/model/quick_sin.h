/// sin and cos for float, computed with 16-bit integers. Freestanding C++14.
///
/// For displacements along a heading, an error of 9e-5 is small compared with sensor errors. On an
/// 8-bit processor, these functions take a seventh of the cycles of float_math::sin, and integer
/// results are the same on every machine.
#pragma once

#include <stdint.h>

#include "awmr/model/float_bearing.h"
#include "awmr/model/float_math.h"

namespace awmr {
namespace float_math {
namespace detail {

/// Sine of pi/2 t with fixed-point numbers: `t` is 2^16 times a number in [0, 1), the result 2^15
/// times the sine. The polynomial
///   t (pi/2 - z (c1 - z (c2 - z c3))),   z = t^2
/// is within 6e-7 of the sine. The constants in the code are its coefficients times 2^15.
AWMR_CALLED inline uint16_t sin15(uint16_t t) {
  const uint16_t z = product16(t, t);
  uint16_t p = static_cast<uint16_t>(2605U - product16(z, 143U));
  p = static_cast<uint16_t>(21166U - product16(z, p));
  p = static_cast<uint16_t>(51471U - product16(z, p));
  return product16(t, p);
}

}  // namespace detail

/// sin(x + quarters pi/2), so that quarters = 1 gives the cosine. The error is at most 9e-5 for |x|
/// <= 100. NaN for |x| > kAngleMax.
AWMR_CALLED inline float quick_sin(float x, uint8_t quarters) {
  if (!(magnitude_bits(x) <= bits_of(kAngleMax))) return not_a_number();
  // x in quarter turns, times 2^16.
  const int32_t turn = static_cast<int32_t>(x * 41721.5137F);
  const uint8_t quarter = static_cast<uint8_t>((static_cast<uint32_t>(turn) >> 16U) + quarters);
  const uint16_t t = static_cast<uint16_t>(turn);
  const uint16_t size = detail::sin15((quarter & 1U) != 0 ? static_cast<uint16_t>(~t) : t);
  if (size == 0) return 0.0F;
  // Divides by 2^15 exactly, by subtracting 15 from the exponent of the float.
  const uint32_t bits = bits_of(static_cast<float>(size)) - (static_cast<uint32_t>(15) << 23U);
  return float_of((quarter & 2U) != 0 ? bits | 0x80000000UL : bits);
}

}  // namespace float_math

namespace math {

/// sin x and cos x for displacements along a heading. For float, the error is at most 9e-5 for |x|
/// <= 100; for double, they are ::sin and ::cos.
inline float quick_sin(float x) { return float_math::quick_sin(x, 0); }
inline double quick_sin(double x) { return ::sin(x); }
inline float quick_cos(float x) { return float_math::quick_sin(x, 1); }
inline double quick_cos(double x) { return ::cos(x); }

}  // namespace math
}  // namespace awmr
