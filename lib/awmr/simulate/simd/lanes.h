/// `Lanes`: a vector register of doubles, one lane (element) per run. With this scalar type, the
/// templates of model/ and control/ simulate several vehicles at once. For kernel files only
/// (kernel.inc).
///
/// Before a kernel file includes this file, it defines AWMR_LANES, the name of its instruction set.
/// This name is a namespace around every type here, so each kernel has its own template instances
/// (README.md, rules for kernel code).
#pragma once

#include <xsimd/xsimd.hpp>

#include "awmr/model/scalar_math.h"

#ifndef AWMR_LANES
#error "lanes.h is for kernel files, which define AWMR_LANES"
#endif
#define AWMR_LANE_INLINE inline __attribute__((always_inline))

namespace awmr {
namespace lanes {
namespace AWMR_LANES {

using Register = xsimd::batch<double, xsimd::AWMR_LANES_ARCH>;
using RegisterMask = xsimd::batch_bool<double, xsimd::AWMR_LANES_ARCH>;

/// One bool per lane: the result of comparing two `Lanes`.
struct LaneMask {
  RegisterMask mask;
  LaneMask() = default;
  AWMR_LANE_INLINE LaneMask(const RegisterMask& of) : mask(of) {}
  AWMR_LANE_INLINE explicit LaneMask(bool everywhere)
      : mask(Register(everywhere ? 1.0 : 0.0) > Register(0.0)) {}
};

/// One double per lane. A double can be converted to Lanes, so that templates can write T(1.0).
struct Lanes {
  Register value;
  Lanes() = default;
  AWMR_LANE_INLINE Lanes(const Register& of) : value(of) {}
  AWMR_LANE_INLINE Lanes(double everywhere) : value(everywhere) {}

  static constexpr int kCount = static_cast<int>(Register::size);
  static AWMR_LANE_INLINE Lanes load(const double* from) { return Register::load_unaligned(from); }
  AWMR_LANE_INLINE void store(double* to) const { value.store_unaligned(to); }
};

}  // namespace AWMR_LANES
}  // namespace lanes

template <>
struct MaskOf<lanes::AWMR_LANES::Lanes> {
  using Type = lanes::AWMR_LANES::LaneMask;
  static constexpr bool kOneLane = false;
};

namespace lanes {
namespace AWMR_LANES {

AWMR_LANE_INLINE Lanes operator+(const Lanes& a, const Lanes& b) { return a.value + b.value; }
AWMR_LANE_INLINE Lanes operator-(const Lanes& a, const Lanes& b) { return a.value - b.value; }
AWMR_LANE_INLINE Lanes operator*(const Lanes& a, const Lanes& b) { return a.value * b.value; }
AWMR_LANE_INLINE Lanes operator/(const Lanes& a, const Lanes& b) { return a.value / b.value; }
AWMR_LANE_INLINE LaneMask operator<(const Lanes& a, const Lanes& b) { return a.value < b.value; }
AWMR_LANE_INLINE LaneMask operator<=(const Lanes& a, const Lanes& b) { return a.value <= b.value; }
AWMR_LANE_INLINE LaneMask operator>(const Lanes& a, const Lanes& b) { return a.value > b.value; }
AWMR_LANE_INLINE LaneMask operator>=(const Lanes& a, const Lanes& b) { return a.value >= b.value; }
AWMR_LANE_INLINE LaneMask operator&&(const LaneMask& a, const LaneMask& b) {
  return a.mask & b.mask;
}
AWMR_LANE_INLINE LaneMask operator||(const LaneMask& a, const LaneMask& b) {
  return a.mask | b.mask;
}

/// Flips the sign bit. (The negation of xsimd 8 for AVX-512 computes 0 - x, which gives 0 and not
/// -0 for x = 0.)
AWMR_LANE_INLINE Lanes operator-(const Lanes& a) { return a.value ^ Register(-0.0); }
AWMR_LANE_INLINE Lanes& operator+=(Lanes& a, const Lanes& b) { return a = a + b; }
AWMR_LANE_INLINE Lanes& operator-=(Lanes& a, const Lanes& b) { return a = a - b; }

AWMR_LANE_INLINE LaneMask operator!(const LaneMask& a) { return !a.mask; }
AWMR_LANE_INLINE bool any(const LaneMask& a) { return xsimd::any(a.mask); }
AWMR_LANE_INLINE bool all(const LaneMask& a) { return xsimd::all(a.mask); }

AWMR_LANE_INLINE Lanes select(const LaneMask& m, const Lanes& a, const Lanes& b) {
  return xsimd::select(m.mask, a.value, b.value);
}
AWMR_LANE_INLINE LaneMask select(const LaneMask& m, const LaneMask& a, const LaneMask& b) {
  return (m && a) || (!m && b);
}

/// a b + c, rounded once. (The function of xsimd 8 for AVX-512 would round twice.)
AWMR_LANE_INLINE Lanes fma(const Lanes& a, const Lanes& b, const Lanes& c) {
#ifdef __AVX512F__
  return Register(_mm512_fmadd_pd(a.value, b.value, c.value));
#else
  return xsimd::fma(a.value, b.value, c.value);
#endif
}
/// The value of a number without derivatives (model/rest.h).
AWMR_LANE_INLINE Lanes value_of(const Lanes& a) { return a; }
AWMR_LANE_INLINE Lanes abs(const Lanes& a) { return xsimd::abs(a.value); }
AWMR_LANE_INLINE Lanes larger(const Lanes& a, const Lanes& b) {
  return xsimd::max(b.value, a.value);
}
AWMR_LANE_INLINE Lanes sqrt(const Lanes& a) { return xsimd::sqrt(a.value); }

}  // namespace AWMR_LANES
}  // namespace lanes
}  // namespace awmr
