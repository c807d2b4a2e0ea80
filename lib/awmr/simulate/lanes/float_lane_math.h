/// pow, sin and cos for lanes of float32. Polynomials are Chebyshev fits on the reduced interval,
/// their error below 2e-8 of the result. Where an argument is out of the range that they are made
/// for, the result is NaN. The worst errors, over these ranges: tests/simulate/lane_math_test.cpp.
#pragma once

#include <cstdint>

#include "awmr/simulate/lanes/lane_math.h"

namespace awmr {
namespace lanes {
namespace AWMR_LANES {

using FloatBits = xsimd::batch<std::uint32_t, xsimd::AWMR_LANES_ARCH>;

/// log2(x) for x in the normal range: split() and log2_of_normal() of lane_math.h with 23 bits of
/// fraction. x = m 2^k, s = (m - 1)/(m + 1),
///   log2(x) = k + 2/ln 2 (s + s^3/3 + s^5/5 + ...)
AWMR_LANE_INLINE FloatLanes log2_of_normal(const FloatLanes& x) {
  constexpr double kSeries[] = {0x1.55555cp-2, 0x1.997c2ep-3, 0x1.2ee656p-3};
  constexpr double kTwoOverLn2 = 0x1.715476p+1;
  constexpr std::uint32_t kRootHalf = 0x3F3504F3U;
  constexpr std::uint32_t kOne = 0x3F800000U;
  FloatLanes m, k;
  for (int i = 0; i < FloatLanes::kRegisters; ++i) {
    const FloatBits bits = xsimd::bitwise_cast<FloatBits>(x.part[i]);
    const FloatBits biased = (bits + FloatBits(kOne - kRootHalf)) >> 23;
    // A whole number n < 2^23 in the fraction of 2^23 is 2^23 + n.
    k.part[i] = xsimd::bitwise_cast<FloatRegister>(biased | FloatBits(0x4B000000U)) -
                FloatRegister(0x1p23F + 127.0F);
    m.part[i] = xsimd::bitwise_cast<FloatRegister>(bits - ((biased << 23) - FloatBits(kOne)));
  }
  const FloatLanes s = (m - FloatLanes(1.0)) / (m + FloatLanes(1.0));
  const FloatLanes z = s * s;
  const FloatLanes ln_half = fma(s * z, polynomial(kSeries, z), s);
  return fma(ln_half, FloatLanes(kTwoOverLn2), k);
}

/// 2^y for |y| < 120.
AWMR_LANE_INLINE FloatLanes exp2_of_normal(const FloatLanes& y) {
  constexpr double kSeries[] = {0x1.000000p+0, 0x1.62e430p-1,  0x1.ebfbe0p-3, 0x1.c6aeccp-5,
                                0x1.3b2a1cp-7, 0x1.5f48c0p-10, 0x1.444000p-13};
  constexpr double kFloatRounder = 0x1.8p23;  // as kRounder, for |y| < 2^22
  const FloatLanes rounded = y + FloatLanes(kFloatRounder);
  const FloatLanes fraction = y - (rounded - FloatLanes(kFloatRounder));
  return by_register<FloatLanes>(
      [](const FloatRegister& value, const FloatRegister& power) {
        return xsimd::bitwise_cast<FloatRegister>(xsimd::bitwise_cast<FloatBits>(value) +
                                                  (xsimd::bitwise_cast<FloatBits>(power) << 23));
      },
      polynomial(kSeries, fraction), rounded);
}

/// x^y for x in the normal range; what is below 2^-120 counts as that, what is above 2^120 is NaN.
AWMR_LANE_INLINE FloatLanes pow(const FloatLanes& x, const FloatLanes& y) {
  const FloatLanes power = y * log2_of_normal(x);
  const FloatLanes at_least = select(power < FloatLanes(-120.0), FloatLanes(-120.0), power);
  return only_where(x >= FloatLanes(0x1p-126) && power < FloatLanes(120.0),
                    exp2_of_normal(at_least));
}

/// Within a sample a vehicle turns, and its wheels are steered, by less than a quarter turn: no
/// angle is reduced. NaN beyond.
constexpr double kLargestFloatAngle = 1.5708;

AWMR_LANE_INLINE FloatLanes sin(const FloatLanes& x) {
  constexpr double kSin[] = {-0x1.555554p-3, 0x1.11104ep-7, -0x1.9fb686p-13, 0x1.61a18ap-19};
  const FloatLanes z = x * x;
  return only_where(abs(x) <= FloatLanes(kLargestFloatAngle), fma(x * z, polynomial(kSin, z), x));
}
AWMR_LANE_INLINE FloatLanes cos(const FloatLanes& x) {
  constexpr double kCos[] = {0x1.555556p-5, -0x1.6c163ep-10, 0x1.9fd76ap-16, -0x1.1d0946p-22};
  const FloatLanes z = x * x;
  return only_where(abs(x) <= FloatLanes(kLargestFloatAngle),
                    fma(z * z, polynomial(kCos, z), fma(z, FloatLanes(-0.5), FloatLanes(1.0))));
}

}  // namespace AWMR_LANES
}  // namespace lanes
}  // namespace awmr
