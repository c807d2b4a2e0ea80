#define AWMR_LANES neon
#define AWMR_LANES_ARCH neon64
#include "awmr/simulate/simd/kernel.inc"
