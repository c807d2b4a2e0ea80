/// Type of the lanes (vector registers) of the instruction set for which a file is compiled, and
/// whether this processor supports that set. For files compiled into one program per instruction
/// set.
#pragma once

#if defined(__AVX512F__)
#define AWMR_LANES avx512
#define AWMR_LANES_ARCH avx512f
#elif defined(__AVX2__)
#define AWMR_LANES avx2
#define AWMR_LANES_ARCH fma3<xsimd::avx2>
#else
#error "lanes need AVX2 or AVX-512"
#endif

#include "awmr/simulate/simd/lane_math.h"

namespace awmr {
namespace testing {

inline bool has_instructions() {
#if defined(__AVX512F__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma");
#else
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
}

}  // namespace testing
}  // namespace awmr
