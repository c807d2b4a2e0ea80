/// The kernels (compiled steps of the closed loop for each instruction set) that this processor can
/// run. Private to simulate/.
#pragma once

#include <vector>

#include "awmr/simulate/lanes/row.h"
#include "awmr/simulate/loop_steps.h"

namespace awmr {
namespace lanes {

/// The steps of the closed loop for one instruction set.
using Kernel = LoopSteps<Row>;

}  // namespace lanes
}  // namespace awmr

extern "C" {
extern const awmr::lanes::Kernel awmr_lanes_avx2;
extern const awmr::lanes::Kernel awmr_lanes_avx512;
extern const awmr::lanes::Kernel awmr_lanes_neon;
}

namespace awmr {
namespace lanes {

/// The kernels that are built and that this processor can run, the widest first. Empty: runs are
/// simulated one at a time by simulate().
std::vector<const Kernel*> supported_kernels();

}  // namespace lanes
}  // namespace awmr
