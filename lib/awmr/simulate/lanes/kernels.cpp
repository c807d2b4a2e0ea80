#include "awmr/simulate/lanes/kernels.h"

namespace awmr {
namespace lanes {

std::vector<const Kernel*> supported_kernels(StepFormat format) {
  std::vector<const Kernel*> kernels;
  [[maybe_unused]] const auto add = [&](const Kernel& in_double, const Kernel& in_float32) {
    kernels.push_back(format == StepFormat::kDouble ? &in_double : &in_float32);
  };
#if defined(AWMR_HAS_LANES) && defined(__aarch64__)
  add(awmr_lanes_neon, awmr_lanes_neon_float32);
#elif defined(AWMR_HAS_LANES)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma")) {
    add(awmr_lanes_avx512, awmr_lanes_avx512_float32);
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    add(awmr_lanes_avx2, awmr_lanes_avx2_float32);
  }
  add(awmr_lanes_sse2, awmr_lanes_sse2_float32);
#endif
  return kernels;
}

}  // namespace lanes
}  // namespace awmr
