#define AWMR_LANES avx512
#define AWMR_LANES_ARCH avx512f
#include "awmr/simulate/simd/kernel.inc"
