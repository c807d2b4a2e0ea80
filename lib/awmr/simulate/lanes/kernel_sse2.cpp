#define AWMR_LANES sse2
#define AWMR_LANES_ARCH sse2
#define AWMR_LANES_ROUNDING "unfused"
#define AWMR_LANES_REGISTERS 1
#include "awmr/simulate/lanes/kernel.inc"
