/// pow, sin, cos, atan, atan2, hypot and the wrap of an angle for `Lanes` (lanes.h). Each argument
/// is reduced to a short interval, where a polynomial (Chebyshev fit) has a relative error below
/// 1e-17. For an argument outside the range of a function, the result is NaN.
/// tests/simulate/lane_math_test.cpp measures the errors.
#pragma once

#include <cstdint>

#include "awmr/core/units.h"
#include "awmr/simulate/simd/lanes.h"

namespace awmr {
namespace lanes {
namespace AWMR_LANES {

using Bits = xsimd::batch<std::uint64_t, xsimd::AWMR_LANES_ARCH>;

/// Reinterprets the bits of each lane as a 64-bit integer. The cast's template argument is the type
/// of a lane in xsimd 9 and later, and the type of a register in earlier versions.
AWMR_LANE_INLINE Bits to_bits(const Register& x) {
#if XSIMD_VERSION_MAJOR < 9
  return xsimd::bitwise_cast<Bits>(x);
#else
  return xsimd::bitwise_cast<std::uint64_t>(x);
#endif
}
AWMR_LANE_INLINE Register to_register(const Bits& x) {
#if XSIMD_VERSION_MAJOR < 9
  return xsimd::bitwise_cast<Register>(x);
#else
  return xsimd::bitwise_cast<double>(x);
#endif
}

/// Returns `result` in the lanes where `in_range` is true, else NaN.
AWMR_LANE_INLINE Lanes only_where(const LaneMask& in_range, const Lanes& result) {
  return select(in_range, result, Lanes(__builtin_nan("")));
}

/// Polynomial c[0] + c[1] x + c[2] x^2 + ..., computed by two Horner schemes, for the even and for
/// the odd powers of x, which the processor can compute at the same time.
template <int N>
AWMR_LANE_INLINE Lanes polynomial(const double (&c)[N], const Lanes& x) {
  const Lanes z = x * x;
  Lanes last(c[N - 1]), before(c[N - 2]);
#pragma GCC unroll 16
  for (int i = N - 3; i >= 0; --i) {
    const Lanes next = fma(last, z, Lanes(c[i]));
    last = before;
    before = next;
  }
  // `before` is the scheme that starts with c[0], `last` the one that starts with c[1].
  return fma(last, x, before);
}

/// Number that rounds x, |x| < 2^51, to an integer: 1.5 times 2^52. After it is added to x, the
/// last bits of the sum are the integer nearest to x.
constexpr double kRounder = 0x1.8p52;

/// The parts m and k of a positive normal number x = m 2^k, with m in [sqrt(1/2), sqrt 2).
struct Split {
  Lanes m, k;
};
AWMR_LANE_INLINE Split split(const Lanes& x) {
  constexpr std::uint64_t kRootHalf = 0x3FE6A09E667F3BCDULL;
  constexpr std::uint64_t kOne = 0x3FF0000000000000ULL;
  const Bits bits = to_bits(x.value);
  // The biased exponent of x/sqrt(1/2).
  const Bits biased = (bits + Bits(kOne - kRootHalf)) >> 52;
  // The conversion of an integer n < 2^52 to double: n in the mantissa bits of 2^52 gives 2^52 + n.
  const Register k = to_register(biased | Bits(0x4330000000000000ULL)) - Register(0x1p52 + 1023.0);
  return {to_register(bits - ((biased << 52) - Bits(kOne))), k};
}

/// log2(x) for a positive normal number x = m 2^k (see Split), by a series in s:
///   s       = (m - 1)/(m + 1)
///   log2(x) = k + 2/ln 2 (s + s^3/3 + s^5/5 + ...)
AWMR_LANE_INLINE Lanes log2_of_normal(const Lanes& x) {
  constexpr double kSeries[] = {0x1.5555555555558p-2, 0x1.99999999952e2p-3, 0x1.2492492df148dp-3,
                                0x1.c71c62e5800a1p-4, 0x1.7462b4ab2ef6bp-4, 0x1.39fe606542ddep-4,
                                0x1.2b584aae78a57p-4};
  constexpr double kTwoOverLn2 = 0x1.71547652b82fep+1;
  const Split x_is = split(x);
  const Lanes s = (x_is.m - Lanes(1.0)) / (x_is.m + Lanes(1.0));
  const Lanes z = s * s;
  const Lanes ln_half = fma(s * z, polynomial(kSeries, z), s);
  return fma(ln_half, Lanes(kTwoOverLn2), x_is.k);
}

/// 2^y for |y| < 1000.
AWMR_LANE_INLINE Lanes exp2_of_normal(const Lanes& y) {
  constexpr double kSeries[] = {
      0x1.0000000000000p+0,  0x1.62e42fefa39efp-1,  0x1.ebfbdff82c5aep-3,  0x1.c6b08d704a0c6p-5,
      0x1.3b2ab6fb9f1a5p-7,  0x1.5d87fe78a3f9cp-10, 0x1.430913112c61bp-13, 0x1.ffcbfc6da6ed1p-17,
      0x1.62bfc2c86d700p-20, 0x1.b524ebd13a55fp-24, 0x1.e6228acd1c6e5p-28, 0x1.e9ec1fcb69a7fp-32};
  const Lanes rounded = y + Lanes(kRounder);
  const Lanes fraction = y - (rounded - Lanes(kRounder));
  const Lanes p = polynomial(kSeries, fraction);
  return to_register(to_bits(p.value) + (to_bits(rounded.value) << 52));
}

/// x^y for x >= 2^-1022, the smallest normal number. For smaller x, the result is NaN. A result
/// below 2^-1000 is replaced by 2^-1000, a result of 2^1000 or more by NaN.
AWMR_LANE_INLINE Lanes pow(const Lanes& x, const Lanes& y) {
  const Lanes power = y * log2_of_normal(x);
  const Lanes at_least = select(power < Lanes(-1000.0), Lanes(-1000.0), power);
  return only_where(x >= Lanes(0x1p-1022) && power < Lanes(1000.0), exp2_of_normal(at_least));
}

struct SinCos {
  Lanes sin, cos;
};

/// Largest |angle|, rad, for sin and cos. To reduce the angle to |r| <= pi/4, a multiple of pi/2 is
/// subtracted; the integer factor is the quadrant. pi/2 is split into three parts. The first two
/// parts have 33 bits, so that their products with a quadrant up to 2^20 are exact.
constexpr double kLargestAngle = 0x1p20;

AWMR_LANE_INLINE SinCos sin_cos_in_range(const Lanes& x) {
  constexpr double kSin[] = {-0x1.5555555555555p-3, 0x1.1111111110babp-7,   -0x1.a01a019e820aep-13,
                             0x1.71de37946ed6dp-19, -0x1.ae6008d114485p-26, 0x1.5e0a4fc16be59p-33};
  constexpr double kCos[] = {0x1.5555555555555p-5,  -0x1.6c16c16c16963p-10,
                             0x1.a01a019f4ddfdp-16, -0x1.27e4fa16cc2d1p-22,
                             0x1.1eeb67d026ec6p-29, -0x1.907cd8ff5ede7p-37};
  const Lanes rounded = fma(x, Lanes(0x1.45f306dc9c883p-1), Lanes(kRounder));  // 2/pi
  const Lanes quadrant = rounded - Lanes(kRounder);
  Lanes r = fma(quadrant, Lanes(-0x1.921fb54400000p+0), x);
  r = fma(quadrant, Lanes(-0x1.0b4611a600000p-34), r);
  r = fma(quadrant, Lanes(-0x1.3198a2e037073p-69), r);
  const Lanes z = r * r;
  const Lanes s = fma(r * z, polynomial(kSin, z), r);
  const Lanes c = fma(z * z, polynomial(kCos, z), fma(z, Lanes(-0.5), Lanes(1.0)));
  // In odd quadrants, sine and cosine are swapped. The test shifts the last bit of the quadrant to
  // the place where this bit alone is the number 2.0. The second bit of the quadrant is the sign of
  // the sine; the second bit of quadrant + 1 is the sign of the cosine. The code shifts both bits
  // to the sign bit of their result.
  const Bits whole = to_bits(rounded.value);
  const LaneMask swapped = to_register((whole & Bits(std::uint64_t{1})) << 62) > Register(1.0);
  const auto with_sign = [&whole](const Lanes& value, std::uint64_t quadrants_on) -> Lanes {
    const Bits sign = ((whole + Bits(quadrants_on)) & Bits(std::uint64_t{2})) << 62;
    return to_register(to_bits(value.value) ^ sign);
  };
  return {with_sign(select(swapped, c, s), 0), with_sign(select(swapped, s, c), 1)};
}

/// sin and cos; NaN for |x| >= kLargestAngle.
AWMR_LANE_INLINE Lanes sin(const Lanes& x) {
  return only_where(abs(x) < Lanes(kLargestAngle), sin_cos_in_range(x).sin);
}
AWMR_LANE_INLINE Lanes cos(const Lanes& x) {
  return only_where(abs(x) < Lanes(kLargestAngle), sin_cos_in_range(x).cos);
}

/// Direction of the vector (x, y), rad, in [-pi/2, pi/2], for x >= 0. Its magnitude is, with a =
/// |y| and t = tan(pi/8),
///   a <= t x           atan(a/x)
///   t x < a <= x/t     pi/4 + atan((a - x)/(a + x))
///   a > x/t            pi/2 - atan(x/a)
AWMR_LANE_INLINE Lanes angle_ahead(const Lanes& y, const Lanes& x) {
  constexpr double kAtan[] = {-0x1.5555555555555p-2, 0x1.999999999933dp-3,  -0x1.24924924355d5p-3,
                              0x1.c71c7184c32bfp-4,  -0x1.745d0b153ffadp-4, 0x1.3b126143b5cbcp-4,
                              -0x1.10fa5ee9ab25cp-4, 0x1.dfe49b2919c4ep-5,  -0x1.a090d1950d2b4p-5,
                              0x1.41495cefb6c73p-5,  -0x1.39f38ad451ea6p-6};
  constexpr double kTanEighth = 0x1.a827999fcef32p-2;
  const Lanes a = abs(y);
  const LaneMask low = a <= x * Lanes(kTanEighth);
  const LaneMask high = x < a * Lanes(kTanEighth);
  const Lanes above = select(low, a, select(high, -x, a - x));
  const Lanes below = select(low, x, select(high, a, a + x));
  // At the origin, 0/1 replaces 0/0.
  const Lanes t = above / select(below > Lanes(0.0), below, Lanes(1.0));
  const Lanes z = t * t;
  const Lanes base =
      select(low, Lanes(0.0), select(high, Lanes(pi<double>() / 2.0), Lanes(pi<double>() / 4.0)));
  const Lanes angle = base + fma(t * z, polynomial(kAtan, z), t);
  return select(y < Lanes(0.0), -angle, angle);
}

AWMR_LANE_INLINE Lanes atan(const Lanes& x) { return angle_ahead(x, Lanes(1.0)); }

/// The direction of the vector (x, y), rad, in (-pi, pi]; 0 for (0, 0).
AWMR_LANE_INLINE Lanes atan2(const Lanes& y, const Lanes& x) {
  const Lanes ahead = angle_ahead(y, abs(x));
  const Lanes half_turn = select(y < Lanes(0.0), Lanes(-pi<double>()), Lanes(pi<double>()));
  return select(x < Lanes(0.0), half_turn - ahead, ahead);
}

AWMR_LANE_INLINE Lanes hypot(const Lanes& x, const Lanes& y) { return sqrt(x * x + y * y); }

/// wrap_angle() of control/wrap_angle.h for lanes. Subtracts all full turns in one step, because
/// loops would have different lengths in the lanes.
AWMR_LANE_INLINE Lanes wrap_angle(const Lanes& angle_rad) {
  constexpr double kTurn = 0x1.921fb54442d18p+2;
  constexpr double kTurnRest = 0x1.1a62633145c07p-52;
  const Lanes rounded = fma(angle_rad, Lanes(0x1.45f306dc9c883p-3), Lanes(kRounder));  // 1/(2 pi)
  const Lanes turns = rounded - Lanes(kRounder);
  Lanes wrapped = fma(turns, Lanes(-kTurn), angle_rad);
  const LaneMask many = abs(turns) > Lanes(64.0);
  if (any(many)) wrapped = select(many, fma(turns, Lanes(-kTurnRest), wrapped), wrapped);
  wrapped = select(wrapped > Lanes(pi<double>()), wrapped - Lanes(kTurn), wrapped);
  return select(wrapped > Lanes(-pi<double>()), wrapped, wrapped + Lanes(kTurn));
}

}  // namespace AWMR_LANES
}  // namespace lanes
}  // namespace awmr
