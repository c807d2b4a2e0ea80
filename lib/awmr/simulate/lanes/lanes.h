/// `Lanes`: the doubles of one operation, one lane (element of a vector register) per run. It is
/// the scalar type with which the templates of model/ and control/ simulate several vehicles at
/// once. For kernel files only (kernel.inc).
///
/// A kernel file defines AWMR_LANES, the name of its instruction set, before it includes this file.
/// The name is a namespace around every type here, and so part of the name of every template
/// instantiated with such a type. Without it, the linker would merge functions of the same name
/// from several kernels, and could select one that needs a newer processor.
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

/// Vector registers per `Lanes`. With two, the processor computes in one register while it waits
/// for the result in the other; this needs a processor with 32 vector registers.
constexpr int kRegisters = AWMR_LANES_REGISTERS;

/// One bool per lane: the result of comparing two `Lanes`.
struct LaneMask {
  RegisterMask part[kRegisters];
  LaneMask() = default;
  AWMR_LANE_INLINE explicit LaneMask(bool everywhere) {
    for (RegisterMask& one : part) one = Register(everywhere ? 1.0 : 0.0) > Register(0.0);
  }
};

/// One double per lane. Converts from double, so that templates can write T(1.0).
struct Lanes {
  Register part[kRegisters];
  Lanes() = default;
  AWMR_LANE_INLINE Lanes(double everywhere) {
    for (Register& one : part) one = Register(everywhere);
  }

  static constexpr int kWidth = static_cast<int>(Register::size);
  static constexpr int kCount = kRegisters * kWidth;
  static AWMR_LANE_INLINE Lanes load(const double* from) {
    Lanes lanes;
    for (int i = 0; i < kRegisters; ++i)
      lanes.part[i] = Register::load_unaligned(from + i * kWidth);
    return lanes;
  }
  AWMR_LANE_INLINE void store(double* to) const {
    for (int i = 0; i < kRegisters; ++i) part[i].store_unaligned(to + i * kWidth);
  }
};

/// Calls f with the i-th register of each operand, for each i.
template <class Result = Lanes, class F, class... Operands>
AWMR_LANE_INLINE Result by_register(const F& f, const Operands&... operands) {
  Result result;
  for (int i = 0; i < kRegisters; ++i) result.part[i] = f(operands.part[i]...);
  return result;
}

}  // namespace AWMR_LANES
}  // namespace lanes

template <>
struct MaskOf<lanes::AWMR_LANES::Lanes> {
  using Type = lanes::AWMR_LANES::LaneMask;
  static constexpr bool kOneLane = false;
};

namespace lanes {
namespace AWMR_LANES {

#define AWMR_LANES_OPERATOR(Result, Operand, op, part_op)                                       \
  AWMR_LANE_INLINE Result operator op(const Operand& a, const Operand& b) {                     \
    return by_register<Result>([](const auto& x, const auto& y) { return x part_op y; }, a, b); \
  }
AWMR_LANES_OPERATOR(Lanes, Lanes, +, +)
AWMR_LANES_OPERATOR(Lanes, Lanes, -, -)
AWMR_LANES_OPERATOR(Lanes, Lanes, *, *)
AWMR_LANES_OPERATOR(Lanes, Lanes, /, /)
AWMR_LANES_OPERATOR(LaneMask, Lanes, <, <)
AWMR_LANES_OPERATOR(LaneMask, Lanes, <=, <=)
AWMR_LANES_OPERATOR(LaneMask, Lanes, >, >)
AWMR_LANES_OPERATOR(LaneMask, Lanes, >=, >=)
AWMR_LANES_OPERATOR(LaneMask, LaneMask, &&, &)
AWMR_LANES_OPERATOR(LaneMask, LaneMask, ||, |)
#undef AWMR_LANES_OPERATOR

/// Flips the sign bit. For AVX-512, xsimd 8 would compute 0 - x, which is 0 and not -0 for x = 0.
AWMR_LANE_INLINE Lanes operator-(const Lanes& a) {
  return by_register([](const Register& x) { return x ^ Register(-0.0); }, a);
}
AWMR_LANE_INLINE Lanes& operator+=(Lanes& a, const Lanes& b) { return a = a + b; }
AWMR_LANE_INLINE Lanes& operator-=(Lanes& a, const Lanes& b) { return a = a - b; }

AWMR_LANE_INLINE LaneMask operator!(const LaneMask& a) {
  return by_register<LaneMask>([](const RegisterMask& x) { return !x; }, a);
}
AWMR_LANE_INLINE bool any(const LaneMask& a) {
  RegisterMask joined = a.part[0];
  for (int i = 1; i < kRegisters; ++i) joined = joined | a.part[i];
  return xsimd::any(joined);
}
AWMR_LANE_INLINE bool all(const LaneMask& a) {
  RegisterMask joined = a.part[0];
  for (int i = 1; i < kRegisters; ++i) joined = joined & a.part[i];
  return xsimd::all(joined);
}

AWMR_LANE_INLINE Lanes select(const LaneMask& m, const Lanes& a, const Lanes& b) {
  return by_register([](const auto& mask, const Register& x,
                        const Register& y) { return xsimd::select(mask, x, y); },
                     m, a, b);
}
AWMR_LANE_INLINE LaneMask select(const LaneMask& m, const LaneMask& a, const LaneMask& b) {
  return (m && a) || (!m && b);
}

/// a b + c, rounded once. (For AVX-512, xsimd 8 rounds twice.)
AWMR_LANE_INLINE Lanes fma(const Lanes& a, const Lanes& b, const Lanes& c) {
  return by_register(
      [](const Register& x, const Register& y, const Register& z) {
#ifdef __AVX512F__
        return Register(_mm512_fmadd_pd(x, y, z));
#else
        return xsimd::fma(x, y, z);
#endif
      },
      a, b, c);
}
AWMR_LANE_INLINE Lanes abs(const Lanes& a) {
  return by_register([](const Register& x) { return xsimd::abs(x); }, a);
}
AWMR_LANE_INLINE Lanes larger(const Lanes& a, const Lanes& b) {
  return by_register([](const Register& x, const Register& y) { return xsimd::max(y, x); }, a, b);
}
AWMR_LANE_INLINE Lanes sqrt(const Lanes& a) {
  return by_register([](const Register& x) { return xsimd::sqrt(x); }, a);
}

}  // namespace AWMR_LANES
}  // namespace lanes
}  // namespace awmr
