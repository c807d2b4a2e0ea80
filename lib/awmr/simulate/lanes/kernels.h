/// The kernels of the program, and which of them this processor runs. Private to simulate/.
#pragma once

#include <vector>

#include "awmr/simulate/lanes/block.h"

extern "C" {
extern const awmr::lanes::Kernel awmr_lanes_sse2;
extern const awmr::lanes::Kernel awmr_lanes_avx2;
extern const awmr::lanes::Kernel awmr_lanes_avx512;
extern const awmr::lanes::Kernel awmr_lanes_neon;
}

namespace awmr {
namespace lanes {

/// Those that this processor runs, the widest first; none on other processors than x86 and 64-bit ARM.
std::vector<const Kernel*> supported_kernels();

}  // namespace lanes
}  // namespace awmr
