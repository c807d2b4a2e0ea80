#include "awmr/simulate/simd/kernels.h"

namespace awmr {
namespace lanes {

std::vector<const Kernel*> supported_kernels() {
  std::vector<const Kernel*> kernels;
#ifdef AWMR_HAS_AVX512
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma")) {
    kernels.push_back(&awmr_lanes_avx512);
  }
#endif
#ifdef AWMR_HAS_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    kernels.push_back(&awmr_lanes_avx2);
  }
#endif
#ifdef AWMR_HAS_NEON
  kernels.push_back(&awmr_lanes_neon);
#endif
  return kernels;
}

}  // namespace lanes
}  // namespace awmr
