#define AWMR_LANES avx512
#define AWMR_LANES_ARCH avx512f
#define AWMR_LANES_REGISTERS 2
#include "awmr/simulate/lanes/kernel.inc"
