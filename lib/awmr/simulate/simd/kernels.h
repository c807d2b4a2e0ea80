/// List of the kernels that this processor can run. A kernel is the closed loop's arithmetic,
/// compiled for one instruction set. Private to simulate/.
#pragma once

#include <vector>

#include "awmr/simulate/loop_steps.h"
#include "awmr/simulate/simd/row.h"

namespace awmr {
namespace lanes {

/// The functions of the closed loop, compiled for one instruction set.
using Kernel = LoopSteps<Row>;

extern "C" {
extern const Kernel awmr_lanes_avx2;
extern const Kernel awmr_lanes_avx512;
extern const Kernel awmr_lanes_neon;
}

/// Returns the kernels in this program that the processor can run, those with the widest registers
/// first. If there is none, simulate() computes one run at a time.
std::vector<const Kernel*> supported_kernels();

}  // namespace lanes
}  // namespace awmr
