#define AWMR_LANES avx2
#define AWMR_LANES_ARCH fma3<xsimd::avx2>
#include "awmr/simulate/simd/kernel.inc"
