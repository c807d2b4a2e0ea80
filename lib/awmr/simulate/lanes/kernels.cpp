#include "awmr/simulate/lanes/kernels.h"

namespace awmr {
namespace lanes {

std::vector<const Kernel*> supported_kernels() {
  std::vector<const Kernel*> kernels;
#if defined(AWMR_HAS_LANES) && defined(__aarch64__)
  kernels.push_back(&awmr_lanes_neon);
#elif defined(AWMR_HAS_LANES)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma")) {
    kernels.push_back(&awmr_lanes_avx512);
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    kernels.push_back(&awmr_lanes_avx2);
  }
#endif
  return kernels;
}

}  // namespace lanes
}  // namespace awmr
