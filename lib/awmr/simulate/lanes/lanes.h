/// A batch of doubles, or of floats, a lane per trajectory: the scalar with which the templates of
/// model/ and control/ run several vehicles at once. For kernel files alone: see kernel.h.
///
/// A kernel file defines AWMR_LANES, the name of its instruction set, before it includes this. The
/// name is part of every type here and so of every template made with one: the linker takes the
/// first of two functions of the same name, and that may be one for a newer processor.
#pragma once

#include <xsimd/xsimd.hpp>

#include "awmr/model/scalar_math.h"

#ifndef AWMR_LANES
#error "lanes.h is for kernel files, which define AWMR_LANES"
#endif
#define AWMR_LANE_INLINE inline __attribute__((always_inline))
/// All that is called is copied in: lanes live in registers, which a call would spill.
#define AWMR_WHOLE __attribute__((flatten))

namespace awmr {
namespace lanes {
namespace AWMR_LANES {

template <class Number, int Registers>
struct LanesOf;

/// The registers of a batch: with two of them one computes while the other waits for its last
/// result; it takes a processor with 32 registers not to run out of them.
using Lanes = LanesOf<double, AWMR_LANES_REGISTERS>;
/// The same of float32, twice as many in a register.
using FloatLanes = LanesOf<float, AWMR_LANES_FLOAT_REGISTERS>;

/// f of the registers of each place.
template <class Result = Lanes, class F, class... Operands>
AWMR_LANE_INLINE Result by_register(const F& f, const Operands&... operands) {
  Result result;
  for (int i = 0; i < Result::kRegisters; ++i) result.part[i] = f(operands.part[i]...);
  return result;
}

/// Truth by lane.
template <class Number, int Registers>
struct LaneMaskOf {
  using Register = xsimd::batch<Number, xsimd::AWMR_LANES_ARCH>;
  using RegisterMask = xsimd::batch_bool<Number, xsimd::AWMR_LANES_ARCH>;
  static constexpr int kRegisters = Registers;

  RegisterMask part[Registers];
  LaneMaskOf() = default;
  AWMR_LANE_INLINE explicit LaneMaskOf(bool everywhere) {
    for (RegisterMask& one : part) one = Register(everywhere ? 1 : 0) > Register(0);
  }

  friend AWMR_LANE_INLINE LaneMaskOf operator&&(const LaneMaskOf& a, const LaneMaskOf& b) {
    return by_register<LaneMaskOf>([](const auto& x, const auto& y) { return x & y; }, a, b);
  }
  friend AWMR_LANE_INLINE LaneMaskOf operator||(const LaneMaskOf& a, const LaneMaskOf& b) {
    return by_register<LaneMaskOf>([](const auto& x, const auto& y) { return x | y; }, a, b);
  }
  friend AWMR_LANE_INLINE LaneMaskOf operator!(const LaneMaskOf& a) {
    return by_register<LaneMaskOf>([](const RegisterMask& x) { return !x; }, a);
  }
  friend AWMR_LANE_INLINE bool any(const LaneMaskOf& a) {
    RegisterMask joined = a.part[0];
    for (int i = 1; i < Registers; ++i) joined = joined | a.part[i];
    return xsimd::any(joined);
  }
  friend AWMR_LANE_INLINE bool all(const LaneMaskOf& a) {
    RegisterMask joined = a.part[0];
    for (int i = 1; i < Registers; ++i) joined = joined & a.part[i];
    return xsimd::all(joined);
  }
  friend AWMR_LANE_INLINE LaneMaskOf select(const LaneMaskOf& m, const LaneMaskOf& a,
                                            const LaneMaskOf& b) {
    return (m && a) || (!m && b);
  }
};

/// a b + c of a register, rounded once where the processor can. (xsimd 8 has no such function for
/// AVX-512, and rounds twice there.)
template <class Register>
AWMR_LANE_INLINE Register fused(const Register& a, const Register& b, const Register& c) {
#ifdef __AVX512F__
  if constexpr (sizeof(typename Register::value_type) == sizeof(double)) {
    return Register(_mm512_fmadd_pd(a, b, c));
  } else {
    return Register(_mm512_fmadd_ps(a, b, c));
  }
#else
  return xsimd::fma(a, b, c);
#endif
}

/// a/b and the root of a register, rounded as the number's own. (For floats of ARM, xsimd 8 takes
/// estimates with two of Newton's steps, which miss the last place.)
template <class Register>
AWMR_LANE_INLINE Register quotient(const Register& a, const Register& b) {
#ifdef __aarch64__
  if constexpr (sizeof(typename Register::value_type) == sizeof(float)) return vdivq_f32(a, b);
#endif
  return a / b;
}
template <class Register>
AWMR_LANE_INLINE Register root(const Register& a) {
#ifdef __aarch64__
  if constexpr (sizeof(typename Register::value_type) == sizeof(float)) return vsqrtq_f32(a);
#endif
  return xsimd::sqrt(a);
}

/// A register of doubles, or one of floats whose numbers stand in memory as doubles.
using Register = xsimd::batch<double, xsimd::AWMR_LANES_ARCH>;
using FloatRegister = xsimd::batch<float, xsimd::AWMR_LANES_ARCH>;
AWMR_LANE_INLINE void load_register(const double* from, Register& to) {
  to = Register::load_unaligned(from);
}
AWMR_LANE_INLINE void store_register(const Register& from, double* to) { from.store_unaligned(to); }
/// Each number is rounded to the nearest float.
AWMR_LANE_INLINE void load_register(const double* from, FloatRegister& to) {
#if defined(__AVX512F__)
  const __m256 low = _mm512_cvtpd_ps(_mm512_loadu_pd(from));
  const __m256 high = _mm512_cvtpd_ps(_mm512_loadu_pd(from + 8));
  to = FloatRegister(_mm512_castpd_ps(_mm512_insertf64x4(
      _mm512_castps_pd(_mm512_castps256_ps512(low)), _mm256_castps_pd(high), 1)));
#elif defined(__AVX2__)
  to = FloatRegister(_mm256_set_m128(_mm256_cvtpd_ps(_mm256_loadu_pd(from + 4)),
                                     _mm256_cvtpd_ps(_mm256_loadu_pd(from))));
#elif defined(__SSE2__)
  to = FloatRegister(
      _mm_movelh_ps(_mm_cvtpd_ps(_mm_loadu_pd(from)), _mm_cvtpd_ps(_mm_loadu_pd(from + 2))));
#else
  to =
      FloatRegister(vcombine_f32(vcvt_f32_f64(vld1q_f64(from)), vcvt_f32_f64(vld1q_f64(from + 2))));
#endif
}
AWMR_LANE_INLINE void store_register(const FloatRegister& from, double* to) {
#if defined(__AVX512F__)
  _mm512_storeu_pd(to, _mm512_cvtps_pd(_mm512_castps512_ps256(from)));
  _mm512_storeu_pd(
      to + 8, _mm512_cvtps_pd(_mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(from), 1))));
#elif defined(__AVX2__)
  _mm256_storeu_pd(to, _mm256_cvtps_pd(_mm256_castps256_ps128(from)));
  _mm256_storeu_pd(to + 4, _mm256_cvtps_pd(_mm256_extractf128_ps(from, 1)));
#elif defined(__SSE2__)
  _mm_storeu_pd(to, _mm_cvtps_pd(from));
  _mm_storeu_pd(to + 2, _mm_cvtps_pd(_mm_movehl_ps(from, from)));
#else
  vst1q_f64(to, vcvt_f64_f32(vget_low_f32(from)));
  vst1q_f64(to + 2, vcvt_f64_f32(vget_high_f32(from)));
#endif
}

/// Numbers by lane. Converts from double as a scalar would.
template <class Number, int Registers>
struct LanesOf {
  using Register = xsimd::batch<Number, xsimd::AWMR_LANES_ARCH>;
  using Mask = LaneMaskOf<Number, Registers>;
  static constexpr int kRegisters = Registers;
  static constexpr int kWidth = static_cast<int>(Register::size);
  static constexpr int kCount = Registers * kWidth;

  Register part[Registers];
  LanesOf() = default;
  AWMR_LANE_INLINE LanesOf(double everywhere) {
    for (Register& one : part) one = Register(static_cast<Number>(everywhere));
  }

  /// From and to doubles, whatever the lanes hold.
  static AWMR_LANE_INLINE LanesOf load(const double* from) {
    LanesOf lanes;
    for (int i = 0; i < Registers; ++i) load_register(from + i * kWidth, lanes.part[i]);
    return lanes;
  }
  AWMR_LANE_INLINE void store(double* to) const {
    for (int i = 0; i < Registers; ++i) store_register(part[i], to + i * kWidth);
  }

#define AWMR_LANES_OPERATOR(Result, op)                                                    \
  friend AWMR_LANE_INLINE Result operator op(const LanesOf& a, const LanesOf& b) {         \
    return by_register<Result>([](const auto& x, const auto& y) { return x op y; }, a, b); \
  }
  AWMR_LANES_OPERATOR(LanesOf, +)
  AWMR_LANES_OPERATOR(LanesOf, -)
  AWMR_LANES_OPERATOR(LanesOf, *)
  AWMR_LANES_OPERATOR(Mask, <)
  AWMR_LANES_OPERATOR(Mask, <=)
  AWMR_LANES_OPERATOR(Mask, >)
  AWMR_LANES_OPERATOR(Mask, >=)
#undef AWMR_LANES_OPERATOR

  friend AWMR_LANE_INLINE LanesOf operator/(const LanesOf& a, const LanesOf& b) {
    return by_register<LanesOf>([](const Register& x, const Register& y) { return quotient(x, y); },
                                a, b);
  }

  /// By the bit of the sign: xsimd 8 subtracts from 0 for AVX-512, which leaves 0 its sign.
  friend AWMR_LANE_INLINE LanesOf operator-(const LanesOf& a) {
    return by_register<LanesOf>(
        [](const Register& x) { return x ^ Register(static_cast<Number>(-0.0)); }, a);
  }
  friend AWMR_LANE_INLINE LanesOf& operator+=(LanesOf& a, const LanesOf& b) { return a = a + b; }
  friend AWMR_LANE_INLINE LanesOf& operator-=(LanesOf& a, const LanesOf& b) { return a = a - b; }

  friend AWMR_LANE_INLINE LanesOf select(const Mask& m, const LanesOf& a, const LanesOf& b) {
    return by_register<LanesOf>([](const auto& mask, const Register& x,
                                   const Register& y) { return xsimd::select(mask, x, y); },
                                m, a, b);
  }
  friend AWMR_LANE_INLINE LanesOf fma(const LanesOf& a, const LanesOf& b, const LanesOf& c) {
    return by_register<LanesOf>(
        [](const Register& x, const Register& y, const Register& z) { return fused(x, y, z); }, a,
        b, c);
  }
  friend AWMR_LANE_INLINE LanesOf abs(const LanesOf& a) {
    return by_register<LanesOf>([](const Register& x) { return xsimd::abs(x); }, a);
  }
  friend AWMR_LANE_INLINE LanesOf larger(const LanesOf& a, const LanesOf& b) {
    return by_register<LanesOf>(
        [](const Register& x, const Register& y) { return xsimd::max(y, x); }, a, b);
  }
  friend AWMR_LANE_INLINE LanesOf sqrt(const LanesOf& a) {
    return by_register<LanesOf>([](const Register& x) { return root(x); }, a);
  }
};

using LaneMask = Lanes::Mask;
using FloatLaneMask = FloatLanes::Mask;

}  // namespace AWMR_LANES
}  // namespace lanes

template <class Number, int Registers>
struct MaskOf<lanes::AWMR_LANES::LanesOf<Number, Registers>> {
  using Type = lanes::AWMR_LANES::LaneMaskOf<Number, Registers>;
  static constexpr bool kOneLane = false;
};
}  // namespace awmr
