#define AWMR_LANES neon
#define AWMR_LANES_ARCH neon64
#define AWMR_LANES_REGISTERS 2
#include "awmr/simulate/lanes/kernel.inc"
