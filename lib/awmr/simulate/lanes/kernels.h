/// The kernels of the program, and which of them this processor runs. Private to simulate/.
#pragma once

#include <vector>

#include "awmr/simulate/batch.h"
#include "awmr/simulate/lanes/block.h"

extern "C" {
extern const awmr::lanes::Kernel awmr_lanes_sse2;
extern const awmr::lanes::Kernel awmr_lanes_avx2;
extern const awmr::lanes::Kernel awmr_lanes_avx512;
extern const awmr::lanes::Kernel awmr_lanes_neon;
extern const awmr::lanes::Kernel awmr_lanes_sse2_float32;
extern const awmr::lanes::Kernel awmr_lanes_avx2_float32;
extern const awmr::lanes::Kernel awmr_lanes_avx512_float32;
extern const awmr::lanes::Kernel awmr_lanes_neon_float32;
}

namespace awmr {
namespace lanes {

/// Those that this processor runs with steps of this format, the widest first; none on other
/// processors than x86 and 64-bit ARM.
std::vector<const Kernel*> supported_kernels(StepFormat format);

}  // namespace lanes
}  // namespace awmr
